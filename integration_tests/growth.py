#!/usr/bin/env python3
"""What units that share one host and one domain cost each other: discovery traffic, idle traffic and memory.

usage: python3 -m integration_tests.growth [--vendor NAME ...] [--units N ...]

Each unit has three lanes and two voters, and no sensor: what is sent then is discovery and its upkeep. The measurement runs in a network namespace
of its own (needs root), where nothing else uses the loopback.
"""
import argparse
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from integration_tests.harness.processes import BIN, CONFIGURATIONS

DOMAIN = 77
INSIDE = "QUORIENT_GROWTH_INSIDE"
START_S = 40  # both vendors announce participants anew within it
IDLE_S = 60  # two periods of the slower vendor's announcements
SETTLED = 3  # times the idle traffic: a second with more still belongs to the start
LONGEST_S = 300  # the units end by themselves, whatever happens to this program
PARTICIPANTS = 9  # of a unit: three lanes of two, two voters, launch


def loopback_bytes():
    line = next(line for line in pathlib.Path("/proc/net/dev").read_text().splitlines() if line.strip().startswith("lo:"))
    return int(line.split(":")[1].split()[0])


def sent_within(seconds):
    """Bytes on the loopback in the next so many seconds."""
    before, begin_s = loopback_bytes(), time.monotonic()
    while time.monotonic() - begin_s < seconds:
        time.sleep(0.1)
    return loopback_bytes() - before


def children_of(process):
    return [int(child) for child in pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()]


def memory_mib(processes):
    """Each shared page counts in parts."""
    total_kib = 0
    for process in processes:
        rollup = pathlib.Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
        total_kib += next(int(line.split()[1]) for line in rollup if line.startswith("Pss:"))
    return total_kib / 1024


class Fleet:
    """So many launched units. Use as a context: every process is ended by its id."""

    def __init__(self, vendor, units):
        self.folder = tempfile.TemporaryDirectory(prefix="quorient-growth-")
        self.launches = []
        for unit in range(1, units + 1):
            run_directory = pathlib.Path(self.folder.name) / str(unit)
            run_directory.mkdir()
            command = [BIN / "quorient", "launch", CONFIGURATIONS / "demo.yaml", "--dds", vendor, "--domain", DOMAIN, "--without", "sensor", "--join", "--json",
                       "--duration", LONGEST_S]
            for setting in (f"unit.id={unit}", "source.faults=[]", "expect=null"):
                command += ["--set", setting]
            self.launches.append(subprocess.Popen(
                list(map(str, command)), env=dict(os.environ, QUORIENT_RUN_DIR=str(run_directory)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for launch in self.launches:
            if launch.poll() is None:
                launch.send_signal(signal.SIGTERM)
        for launch in self.launches:
            try:
                launch.wait(20)
            except subprocess.TimeoutExpired:
                launch.kill()
                launch.wait()
        self.folder.cleanup()

    def processes(self):
        return [process for launch in self.launches for process in (launch.pid, *children_of(launch.pid))]


def measure(vendor, units):
    """@returns participants, bytes of discovery beyond what idling sends, seconds that it took, bytes per second of idling, memory."""
    with Fleet(vendor, units) as fleet:
        seconds = [sent_within(1) for _ in range(START_S)]
        idle = sent_within(IDLE_S) / IDLE_S
        processes = fleet.processes()
        if len(processes) != PARTICIPANTS * units:
            sys.exit(f"{vendor}, {units} units: {len(processes)} processes run, not {PARTICIPANTS * units}")
        settled_s = max((second + 1 for second, sent in enumerate(seconds) if sent > SETTLED * idle), default=0)
        return len(processes), sum(max(0.0, sent - idle) for sent in seconds[:settled_s]), settled_s, idle, memory_mib(processes)


def exponent(points):
    """Of the power law through the first and the last point."""
    (x0, y0), (x1, y1) = points[0], points[-1]
    return math.log(y1 / y0) / math.log(x1 / x0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vendor", nargs="+", default=["cyclonedds", "fastdds"])
    parser.add_argument("--units", nargs="+", type=int, default=[1, 2, 4, 8])
    options = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # leaves the context, which ends the units
    if INSIDE not in os.environ:
        inside = ["unshare", "-n", "sh", "-c", 'ip link set lo up && exec "$@"', "sh", sys.executable, "-m", "integration_tests.growth", *sys.argv[1:]]
        os.execvpe("unshare", inside, dict(os.environ, **{INSIDE: "yes"}))
    for vendor in options.vendor:
        print(f"\n{vendor}:\n\n| units | participants | discovery [MB] | settled after [s] | idle [kB/s] | memory [MiB] | of a participant [MiB] |\n|---|---|---|---|---|---|---|", flush=True)
        rows = []
        for units in options.units:
            participants, discovery, settled_s, steady, memory = measure(vendor, units)
            rows.append((participants, discovery, steady, memory))
            print(f"| {units} | {participants} | {discovery / 1e6:.2f} | {settled_s:.0f} | {steady / 1e3:.1f} | {memory:.0f} | {memory / participants:.1f} |", flush=True)
        if len(rows) > 1:
            powers = [exponent([(row[0], row[column]) for row in rows]) for column in (1, 2, 3)]
            print(f"\nPower of the number of participants, first to last row: discovery {powers[0]:.2f}, idle traffic {powers[1]:.2f}, memory {powers[2]:.2f}.", flush=True)


if __name__ == "__main__":
    main()
