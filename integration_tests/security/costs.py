"""What security costs: `python3 -m integration_tests.security.costs` runs the demo and its floors at each level in turns and prints the medians.

A floor is the demo's graph of processes straight on one vendor's API, with empty algorithms (integration_tests/latency). There is none of both
vendors: without our bus Fast DDS 2.9.1 aborts beside Cyclone DDS [eProsima/Fast-DDS issue 3285]."""
import argparse
import contextlib
import functools
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

from integration_tests.harness.pipeline import LEVELS, NotInTime, Pipeline, ask_for_priority, at_least_once
from integration_tests.harness.processes import BIN, CONFIGURATIONS
from integration_tests.harness.streams import Recording

GRAPH = BIN / "quorient-latency-graph"  # of the floors; no part of the ordinary build
SETTLED_FRAMES, MEASURED_FRAMES = 300, 700
START_S = 12
STARTS = 4  # of a floor: without our bus secured processes on Fast DDS may never match (common/bus/README.md)
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
SENSOR_STAMP, VOTER_STAMP = 0, 6  # of Hop (common/messages)
# Name as in the demo, role in quorient-latency-graph, number.
FLOOR = (("voter-1", "voter", 1), ("voter-2", "voter", 2),
         *((f"{name}-{lane}", role, number) for number, lane in enumerate("abc") for name, role in (("fdi", "detector"), ("attitude", "integrator"))),
         ("floor-sensor", "sensor", 0))


class Vote(NamedTuple):
    sequence: int
    latency_us: float


class Cost(NamedTuple):
    first_voted_s: float
    latencies_us: list  # sorted
    cpu_ms: float  # of a frame, all services
    missing: int


def parse_vote(sample, _):
    stamps = sample["stamp_ns"]
    return Vote(sample["sequence_number"], (stamps[VOTER_STAMP] - stamps[SENSOR_STAMP]) / 1e3)


def gaps(sequences):
    """@returns how many numbers are missing between the smallest and the largest one."""
    seen = set(sequences)
    return max(seen) - min(seen) + 1 - len(seen)


def processor_s(processes):
    """CPU time so far."""
    total = 0
    for process in processes:
        fields = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        total += int(fields[11]) + int(fields[12])
    return total / TICKS_PER_S


def measure(level, rate_hz):
    with Pipeline("source.duration_s=600", "source.faults=[]", "stamps=true", level=level, rate_hz=rate_hz) as pipeline:
        votes = Recording(pipeline.command("echo", "voter_output", "--json", "--domain", pipeline.domain, *pipeline.with_keys()),
                          pipeline.environment, parse_vote)
        services = lambda: processor_s(map(pipeline.process_of, pipeline.names()))  # noqa: E731
        try:
            pipeline.until_running()
            first_voted_s = pipeline.plain.samples[0].arrival_s - pipeline.launched_s
            pipeline.until_frame(SETTLED_FRAMES)
            first, cpu_s = len(votes.samples), services()
            pipeline.until_frame(SETTLED_FRAMES + MEASURED_FRAMES)
            cpu_s = services() - cpu_s
            measured = sorted(vote.latency_us for vote in votes.samples[first:])
        finally:
            votes.stop()
        missing = pipeline.finish()["voted"]["missing"]
    return Cost(first_voted_s, measured, 1e3 * cpu_s / MEASURED_FRAMES, missing)


def make_keys(directory, domain, level):
    """The demo's, and a sensor's that may see the voters: the floor waits for them before it begins."""
    keys = [BIN / "quorient", "keys", "--out", directory]
    for words in ((CONFIGURATIONS / "demo.yaml", "--domain", domain, "--set", f"security.level={level}", "--set", f"security.directory={directory}"),
                  ("--add", "floor-sensor", "--role", "sensor", "--subscribe", "quorient/voter_output")):
        subprocess.run(list(map(str, [*keys, *words])), check=True, stdout=subprocess.DEVNULL, timeout=30)


@contextlib.contextmanager
def running(commands):
    """Each is ended by its id. @returns their ids."""
    processes = [subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for command in commands]
    try:
        yield [process.pid for process in processes]
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            process.wait(timeout=10)


def measure_floor(level, rate_hz, vendor):
    domain = 120 + int.from_bytes(os.urandom(2), "big") % 100
    directory = pathlib.Path(tempfile.mkdtemp(prefix="quorient-floor-"))
    try:
        keys = ("--keys", directory / "keys") if level != "none" else ()
        if keys:
            make_keys(keys[1], domain, level)
        graph = [GRAPH]
        floor = [[*graph, role, "--number", number, "--dds", vendor, "--domain", domain, "--rate", rate_hz, "--duration", 600,
                  *keys, *(("--as", name) if keys else ())] for name, role, number in FLOOR]
        begin_s = time.monotonic()
        with running(floor) as processes:
            votes = Recording(list(map(str, (BIN / "quorient", "echo", "voter_output", "--json", "--dds", vendor, "--domain", domain, *keys))), os.environ, parse_vote)
            try:
                def until(sequence):
                    deadline = time.monotonic() + START_S + sequence / rate_hz
                    while not votes.newest or votes.newest.sequence < sequence:
                        if time.monotonic() > deadline:
                            raise NotInTime(f"the floor on {vendor} at level {level} does not reach frame {sequence}")
                        time.sleep(0.01)
                    return len(votes.samples), processor_s(processes)

                until(0)
                first_voted_s = time.monotonic() - begin_s
                first, cpu_s = until(SETTLED_FRAMES)
                last, end_s = until(SETTLED_FRAMES + MEASURED_FRAMES)
            finally:
                votes.stop()
        measured = votes.samples[first:last]
        return Cost(first_voted_s, sorted(vote.latency_us for vote in measured), 1e3 * (end_s - cpu_s) / MEASURED_FRAMES,
                    gaps(vote.sequence for vote in measured))
    finally:
        shutil.rmtree(directory, ignore_errors=True)


def measure_started_floor(level, rate_hz, vendor):
    for start in range(1, STARTS + 1):
        try:
            return measure_floor(level, rate_hz, vendor)
        except NotInTime as problem:
            print(f"start {start}: {problem}", file=sys.stderr, flush=True)
    raise NotInTime(f"the floor on {vendor} at level {level} did not start {STARTS} times")


def row(level, who, runs):
    p50, p99 = ([run.latencies_us[int(len(run.latencies_us) * part)] for run in runs] for part in (0.5, 0.99))
    return (f"| {level} | {who} | {statistics.median(run.first_voted_s for run in runs):.2f} | {statistics.median(p50):.0f} | {statistics.median(p99):.0f} | "
            f"{statistics.median(run.cpu_ms for run in runs):.2f} | {sum(run.missing for run in runs)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=at_least_once, default=5)
    parser.add_argument("--rate", type=at_least_once, default=100, help="frames per second")
    parser.add_argument("--without-floor", action="store_true", help="the demo alone, where quorient-latency-graph is not built")
    options = parser.parse_args()
    if not (options.without_floor or GRAPH.exists()):
        sys.exit(f"no {GRAPH}: cmake --build {BIN.parent} --target {GRAPH.name}, or leave the floors out by --without-floor")
    ask_for_priority()
    floors = {f"floor, {name}": functools.partial(measure_started_floor, vendor=vendor) for name, vendor in (("Cyclone DDS", "cyclonedds"), ("Fast DDS", "fastdds"))}
    measures = {"demo": measure} | ({} if options.without_floor else floors)
    costs = {(level, who): [] for level in LEVELS for who in measures}
    for _ in range(options.rounds):
        for level, who in costs:
            costs[level, who].append(measures[who](level, options.rate))
    print("| level | | first voted frame [s] | latency p50 [us] | p99 [us] | processor time a frame, all services [ms] | "
          f"voted frames missing, of {options.rounds} runs |\n|---|---|---|---|---|---|---|")
    for (level, who), runs in costs.items():
        print(row(level, who, runs))
    print(f"\nMedians of {options.rounds} runs of each in turns, {options.rate} Hz, {os.cpu_count()} processors, {MEASURED_FRAMES} frames in each; "
          f"load at the end {os.getloadavg()[0]:.1f}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
