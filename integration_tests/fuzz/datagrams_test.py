"""RTPS datagrams, damaged, sent to the ports of a running pipeline, plain and encrypted: nothing crashes, hangs or grows.

QUORIENT_FUZZ_DATAGRAMS: how many for each vendor (default 6000); QUORIENT_FUZZ_SEED: another run of chance.
"""
import os
import pathlib
import random
import socket
import sys
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
from integration_tests.harness.foreign import InteropTest
from integration_tests.harness.processes import CONFIGURATIONS

COUNT = int(os.environ.get("QUORIENT_FUZZ_DATAGRAMS", 6000))
SEED = int(os.environ.get("QUORIENT_FUZZ_SEED", 1))
HEADER = 20
EDGES = (0, 1, 3, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)
GROWTH_KB = 16 * 1024
DEMO = CONFIGURATIONS / "demo.yaml"


def corpus():
    """@returns (port above the domain's first, bytes) of each recorded datagram."""
    lines = [line.split() for line in (HERE / "datagrams.txt").read_text().splitlines() if not line.startswith("#")]
    return [(int(port), bytes.fromhex(content)) for port, content in lines]


def damaged(content, chance):
    """One datagram with its damage: bits, lengths, ends, submessages in another order, or none."""
    data = bytearray(content)
    what = chance.randrange(8)
    if what == 0:
        return bytes(data)
    if what == 1:
        return bytes(data[: chance.randrange(len(data))])
    if what == 2:
        return bytes(data + chance.randbytes(chance.randrange(1, 600)))
    for _ in range(chance.randrange(1, 6)):
        if len(data) <= 8:
            break
        place = chance.randrange(4, len(data))
        if what in (3, 4):
            data[place] ^= 1 << chance.randrange(8)
        elif what == 5:
            size = chance.choice((1, 2, 4, 8))
            value = chance.choice(EDGES) % 2 ** (8 * size)
            data[place : place + size] = value.to_bytes(size, chance.choice(("little", "big")))
        elif what == 6:
            data[place:place] = data[HEADER : HEADER + chance.randrange(4, 200)]
        else:
            del data[place : place + chance.randrange(1, 64)]
    return bytes(data)


def resident_kb(process):
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1])


class Datagrams(InteropTest):
    reader = ()  # options of a verb that reads the system's topics

    def survives(self, vendor, *arguments):
        chance = random.Random(SEED)
        recorded = corpus()
        services = self.start_services(DEMO, "--dds", vendor, "--set", "source.duration_s=120", "--set", "source.faults=[]", *arguments, sensor=True)
        self.eventually(lambda: self.newest_frame() > 200, "the pipeline runs", timeout=40)
        first = 7400 + 250 * self.domain
        ports = [port for port in range(first + 10, first + 10 + 2 * len(services) + 6)]
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(sender.close)
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))

        def send(count):
            for number in range(count):
                port, content = chance.choice(recorded)
                datagram = damaged(content, chance)
                if port == 0:
                    sender.sendto(datagram, ("239.255.0.1", first))
                # Discovery goes to even ports, samples to odd ones; now and then to the other.
                wanted = [p for p in ports if p % 2 == port % 2] if chance.randrange(10) else ports
                sender.sendto(datagram, ("127.0.0.1", chance.choice(wanted)))
                if number % 50 == 49:
                    time.sleep(0.01)  # 5000 in a second: the kernel's buffers are not what is tested

        send(COUNT // 3)
        warm = {name: resident_kb(process) for name, (process, _) in services.items() if process.poll() is None}
        send(COUNT - COUNT // 3)
        self.all_alive(services)
        for name, (process, _) in services.items():
            self.assertLess(resident_kb(process), warm[name] + GROWTH_KB, f"{name} grows")
        # Nobody hangs: every service says how it is, and frames are still voted on.
        before = self.newest_frame()
        self.eventually(lambda: self.newest_frame() > before + 50, "frames are voted on after it all")
        print(f"{self.id()}: {COUNT} datagrams, seed {SEED}", file=sys.stderr)

    def survives_encrypted(self, vendor):
        """The datagrams are those of a node that proves nothing."""
        keys = self.run_directory / "keys"
        made = self.run_program("quorient", "keys", DEMO, "--out", keys, "--domain", self.domain)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.reader = ("--keys", keys, "--dds", vendor)
        self.survives(vendor, "--set", f"security.directory={keys}", "--set", "source.rate_hz=50")

    def newest_frame(self):
        return max((sample["sequence_number"] for sample in self.echo("voter_output", 66, *self.reader)), default=0)

    def test_cyclonedds_survives(self):
        self.survives("cyclonedds")

    def test_fastdds_survives(self):
        self.survives("fastdds")

    def test_cyclonedds_survives_encrypted(self):
        self.survives_encrypted("cyclonedds")

    def test_fastdds_survives_encrypted(self):
        self.survives_encrypted("fastdds")


if __name__ == "__main__":
    unittest.main(verbosity=2)
