"""What damaged datagrams do to a plain Fast DDS node, which has no guard: how many it survives, and how it ends.

python3 -m integration_tests.fuzz.plain_node [--seeds N] [--without-statistics]: this machine's release; with QUORIENT_NODES_RELEASE=trixie
that one, in its root. Without statistics: the recorded datagrams lose the submessage that Fast DDS adds to its own.
"""
import argparse
import os
import pathlib
import random
import signal
import socket
import subprocess
import tempfile
import time

from integration_tests.fuzz.datagrams_test import corpus, damaged
from integration_tests.harness.foreign import consumer

COUNT = 6000
BATCH = 50
DOMAIN = 77
FIRST = 7400 + 250 * DOMAIN
PORTS = range(FIRST + 10, FIRST + 16)
LARGEST_KB = 512 * 1024
NODE = "consumer_fastdds"
STATISTICS_BYTES = 60  # header and content


def descendants(process):
    children = [int(pid) for file in pathlib.Path(f"/proc/{process}/task").glob("*/children") for pid in file.read_text().split()]
    return children + [pid for child in children for pid in descendants(child)]


def node_of(process):
    """@returns the node's own process, which is that process or a descendant of it; nothing while it is not there."""
    for pid in (process.pid, *descendants(process.pid)):
        file = pathlib.Path(f"/proc/{pid}/comm")
        if file.exists() and file.read_text().strip() == NODE[:15]:
            return pid


def resident_kb(process):
    try:
        return int(pathlib.Path(f"/proc/{node_of(process)}/status").read_text().split("VmRSS:")[1].split()[0])
    except (OSError, IndexError):  # it has ended
        return 0


def wait_for(what, timeout_s=20):
    end_s = time.monotonic() + timeout_s
    while not what() and time.monotonic() < end_s:
        time.sleep(0.05)
    return what()


def listens():
    ports = {int(line.split()[1].split(":")[1], 16) for line in pathlib.Path("/proc/net/udp").read_text().splitlines()[1:]}
    return FIRST + 10 in ports


def stopped(node):
    """@returns how a living node ends."""
    node.send_signal(signal.SIGTERM)
    try:
        return f"survives, ends with {node.wait(20)} when asked"
    except subprocess.TimeoutExpired:
        os.kill(node_of(node), signal.SIGKILL)
        node.wait(20)
        return "hangs: does not end in 20 s when asked"


def without_statistics(content):
    return content[:-STATISTICS_BYTES] if content[-STATISTICS_BYTES:][:1] == b"\x80" else content


def attack(seed, recorded):
    """@returns how the node fared, in words."""
    chance = random.Random(seed)
    with tempfile.TemporaryFile() as log, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        node = subprocess.Popen(list(map(str, (*consumer(NODE), DOMAIN))), stdout=subprocess.DEVNULL, stderr=log)
        assert wait_for(listens), "the node does not start"
        largest = 0
        for number in range(COUNT):
            port, content = chance.choice(recorded)
            wanted = [p for p in PORTS if p % 2 == port % 2] if chance.randrange(10) else PORTS
            sender.sendto(damaged(content, chance), ("127.0.0.1", chance.choice(wanted)))
            if number % BATCH < BATCH - 1:
                continue
            time.sleep(0.02)
            largest = max(largest, resident_kb(node))
            if node.poll() is not None or largest > LARGEST_KB:
                break
        ended = node.poll()
        if ended is None:
            ended = stopped(node)
        else:
            log.seek(0)
            reasons = [line for line in log.read().decode(errors="replace").splitlines() if "Assertion" in line or "what()" in line]
            ended = f"ends with {ended}: {reasons[:1]}"
        return f"seed {seed}: {number + 1} datagrams, up to {largest // 1024} MB, {ended}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--without-statistics", action="store_true")
    options = parser.parse_args()
    datagrams = [(port, without_statistics(content) if options.without_statistics else content) for port, content in corpus()]
    for number in range(1, 1 + options.seeds):
        print(attack(number, datagrams), flush=True)
