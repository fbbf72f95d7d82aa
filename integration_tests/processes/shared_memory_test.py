#!/usr/bin/env python3
"""Shared memory: really in use, seen from outside; its loss and its absence are told; what killed processes leave does not hurt."""
import contextlib
import json
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import time
import unittest

from harness import CONFIGURATIONS, ProcessTest

DEMO = CONFIGURATIONS / "demo.yaml"
MEMORY = pathlib.Path("/dev/shm")
ROUDI = shutil.which("iox-roudi")
LANES = (
    "lanes=[{name: a, detector: {method: vector}, transport: iceoryx},"
    "{name: b, dds: fastdds, detector: {method: vector}, transport: shm},"
    "{name: c, transport: iceoryx, detector: {method: extrapolation}}]"
)
MIXED = ("--set", "sensor.transport=iceoryx", "--set", LANES, "--set", "voters=[{name: voter-1, transport: iceoryx},{name: voter-2, dds: fastdds}]")
QUIET = ("--set", "source.faults=[]", "--set", "expect=null", "--set", "source.duration_s=120")
ONE_LANE = ("--set", "lanes=[{name: a, detector: {method: vector}}]", "--set", "voters=[{name: voter-1}]")


def roudi_answers():
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as probe:
        return probe.connect_ex("/tmp/roudi") == 0


def payload_packets(domain, pattern, seconds):
    """UDP packets of the domain on loopback that carry the bytes."""
    low = 7400 + 250 * domain
    count = 0
    with socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM, socket.htons(0x0800)) as capture:
        capture.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
        capture.bind(("lo", 0))
        capture.settimeout(0.1)
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            with contextlib.suppress(TimeoutError):
                packet, address = capture.recvfrom(65536)
                header = 4 * (packet[0] & 15)
                port = int.from_bytes(packet[header + 2:header + 4], "big")
                outgoing = address[2] == socket.PACKET_OUTGOING  # loopback shows each packet twice
                count += not outgoing and packet[9] == socket.IPPROTO_UDP and low <= port < low + 250 and pattern in packet
    return count


@unittest.skipUnless(ROUDI, "iceoryx is not installed")
class SharedMemory(ProcessTest):
    def setUp(self):
        super().setUp()
        if roudi_answers():
            self.skipTest("an iox-roudi that is not this test's runs on this machine")

    def tearDown(self):
        super().tearDown()
        deadline = time.monotonic() + 5
        while roudi_answers() and time.monotonic() < deadline:  # the launcher's children go with it
            time.sleep(0.02)

    def start_roudi(self):
        process = subprocess.Popen([ROUDI], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.processes.append(process)
        self.eventually(roudi_answers, "iox-roudi answers")
        return process

    def start_demo(self, *arguments):
        pipeline = self.start("quorient", "launch", DEMO, "--domain", self.domain, "--json", *MIXED, *arguments)
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs")
        return pipeline

    def start_one_lane(self, *arguments):
        """Its processes without a launcher, whose monitor reads by UDP."""
        return [
            self.start(program, DEMO, "--name", name, "--domain", self.domain, *ONE_LANE, *QUIET, *arguments)
            for program, name in (("quorient-voter", "voter-1"), ("quorient-attitude", "attitude-a"), ("quorient-fdi", "fdi-a"), ("quorient-sensor", "sensor"))
        ]

    def services(self):
        result = self.run_program("quorient", "status", "--domain", self.domain, "--json")
        return {service["name"]: service for service in json.loads(result.stdout)["services"]} if result.stdout else {}

    def frames_of(self, name):
        return int((self.run_directory / f"{name}.heartbeat").read_text().split()[1])

    def goes_on(self, name, frames=100):
        begin = self.frames_of(name)
        self.eventually(lambda: not begin <= self.frames_of(name) < begin + frames, f"{name} handles frames")

    def log(self, name):
        path = self.run_directory / f"{name}.log"
        return path.read_text() if path.exists() else ""

    def newest_frame(self, *arguments):
        result = self.run_program("quorient", "echo", "frame", "--count", 1, "--json", "--timeout", 10, "--domain", self.domain, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout.splitlines()[0])

    def our_files(self):
        return [file.name for file in MEMORY.iterdir() if file.name.startswith(("fastrtps_", "sem.fastrtps_", "fast_datasharing_", "iceoryx_mgmt"))]

    def test_demo_by_shared_memory_is_as_expected_and_status_names_the_transport(self):
        pipeline = self.start_demo("--set", "source.duration_s=12", "--set", "source.faults=['axis=1,kind=scale,value=0.8,start=5,end=10']")
        services = self.services()
        stdout, _ = pipeline.communicate(timeout=60)
        summary = json.loads(stdout[stdout.index("{"):])
        self.assertEqual(pipeline.returncode, 0, summary["unmet"])
        self.assertEqual({name for name, lane in summary["lanes"].items() if lane["isolated"] == [1]}, {"a", "b", "c"})
        by_iceoryx = {"sensor", "fdi-a", "fdi-c", "attitude-a", "attitude-c", "voter-1"}
        self.assertEqual({name for name, service in services.items() if service["transport"] == "iceoryx"}, by_iceoryx)
        self.assertEqual({name for name, service in services.items() if service["transport"] == "shm"}, {"fdi-b", "attitude-b"})
        for name in ("fdi-a", "attitude-a", "fdi-b", "voter-1"):
            self.assertNotIn("was asked for", self.log(name))

    @unittest.skipUnless(os.geteuid() == 0, "capturing on loopback needs root")
    def test_samples_lie_in_the_segment_and_not_on_the_network(self):
        self.start_roudi()
        for transport in ("iceoryx", "udp"):
            with self.subTest(transport=transport):
                processes = self.start_one_lane("--set", f"transport={transport}")
                self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the lane runs")
                frame = self.newest_frame()  # its reader has left when the capture begins
                epoch = struct.pack("<Q", frame["epoch"])
                packets = payload_packets(self.domain, epoch, 1)
                segments = [file for file in MEMORY.iterdir() if not file.name.startswith(("fastrtps_", "sem.", "iceoryx_mgmt"))]
                samples = sum(file.read_bytes().count(epoch) for file in segments)
                if transport == "iceoryx":
                    self.assertLess(packets, 20)  # events and the reader that leaves; three topics at 200 Hz make 600
                    self.assertGreater(samples, 20)
                else:
                    self.assertGreater(packets, 400)
                    self.assertEqual(samples, 0)
                for process in processes:
                    process.send_signal(signal.SIGTERM)
                for process in processes:
                    self.assertEqual(process.wait(timeout=10), 0)

    def test_without_roudi_a_process_says_so_within_a_second_or_goes_by_udp_with_an_alarm(self):
        begin = time.monotonic()
        refused = self.run_program("quorient-fdi", DEMO, "--name", "fdi-a", "--domain", self.domain, *ONE_LANE, "--set", "transport=iceoryx")
        self.assertLess(time.monotonic() - begin, 1)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("iox-roudi does not answer", refused.stderr)
        processes = self.start_one_lane("--set", "transport=iceoryx", "--set", "shared_memory=preferred")
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the lane runs")
        events = self.run_program("quorient", "echo", "event", "--json", "--count", 8, "--timeout", 5, "--domain", self.domain)
        alarms = [event for event in map(json.loads, events.stdout.splitlines()) if "iceoryx was asked for" in event["text"]]
        self.assertTrue(alarms, events.stdout)
        self.assertEqual({event["severity"] for event in alarms}, {3})
        for process in processes:
            process.terminate()

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("unshare"), "another /dev/shm needs root")
    def test_a_silent_fallback_of_fastdds_raises_the_alarm(self):
        for options, expected in (("ro", True), ("rw", False)):
            with self.subTest(options=options):
                command = self.command(
                    "quorient-fdi", DEMO, "--name", "fdi-a", "--domain", self.domain, *ONE_LANE, "--set", "dds=fastdds", "--set", "transport=shm"
                )
                script = f'mount -t tmpfs -o {options} tmpfs /dev/shm && exec "$@"'
                process = subprocess.Popen(
                    ["unshare", "-m", "sh", "-c", script, "sh", *command], env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
                )
                self.processes.append(process)
                self.eventually(lambda: (self.run_directory / "fdi-a.heartbeat").exists(), "the detector runs")
                time.sleep(1.2)  # two looks at its endpoints: that nothing is said can only be seen by waiting
                process.terminate()
                told = "shm was asked for" in process.communicate(timeout=10)[0]
                (self.run_directory / "fdi-a.heartbeat").unlink()
                self.assertEqual(told, expected)

    def test_the_death_of_roudi_is_told_and_a_lane_comes_back_although_another_roudi_runs(self):
        pipeline = self.start_demo(*QUIET)
        children = subprocess.run(["pgrep", "-P", str(pipeline.pid), "iox-roudi"], capture_output=True, text=True).stdout.split()
        self.assertEqual(len(children), 1)
        self.assertNotIn("daemon is gone", self.log("fdi-a"))
        os.kill(int(children[0]), signal.SIGKILL)
        for name in ("fdi-a", "attitude-c", "sensor"):
            self.eventually(lambda name=name: "daemon is gone" in self.log(name), f"{name} tells it")
        self.goes_on("fdi-a")  # those who share memory go on
        self.start_roudi()
        os.kill(self.services()["fdi-a"]["process"], signal.SIGKILL)
        self.eventually(lambda: "was asked for" in self.log("fdi-a"), "fdi-a is back, by UDP")
        self.goes_on("fdi-a")
        self.goes_on("attitude-a")
        pipeline.terminate()
        self.assertEqual(pipeline.wait(timeout=10), 0)

    def test_what_killed_processes_leave_stops_nobody_and_is_cleaned_when_nobody_uses_it(self):
        for _ in range(2):
            pipeline = self.start_demo(*QUIET)
            cleaned = self.run_program("quorient", "clean")
            self.assertEqual(cleaned.returncode, 1)
            self.assertIn("uses it", cleaned.stderr)
            self.goes_on("fdi-a")
            self.goes_on("fdi-b")
            pipeline.kill()  # and with it all of its children
            pipeline.wait(timeout=10)
            self.eventually(lambda: not roudi_answers(), "iox-roudi is dead")
        self.assertTrue(self.our_files())
        self.eventually(lambda: self.run_program("quorient", "clean").returncode == 0, "nobody uses the files")
        self.assertEqual(self.our_files(), [])
        self.assertEqual(list(self.run_directory.glob("*.heartbeat")), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
