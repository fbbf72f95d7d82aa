"""What security costs: `python3 -m integration_tests.security.costs` runs the demo at each level in turns and prints the medians."""
import argparse
import os
import pathlib
import statistics
import sys

from integration_tests.harness.pipeline import Pipeline, ask_for_priority, at_least_once
from integration_tests.harness.streams import Recording

LEVELS = ("none", "sign", "encrypt")
SETTLED_FRAMES, MEASURED_FRAMES = 300, 1500
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
SENSOR_STAMP, VOTER_STAMP = 0, 6  # of Hop (common/messages)


def parse_latency_us(sample, _):
    stamps = sample["stamp_ns"]
    return (stamps[VOTER_STAMP] - stamps[SENSOR_STAMP]) / 1e3


def processor_s(pipeline):
    """CPU time of the services so far."""
    total = 0
    for name in pipeline.names():
        fields = pathlib.Path(f"/proc/{pipeline.process_of(name)}/stat").read_text().rpartition(")")[2].split()
        total += int(fields[11]) + int(fields[12])
    return total / TICKS_PER_S


def measure(level, rate_hz):
    """@returns time until the first voted frame [s], latencies [us], CPU time per frame [ms], voted frames missing."""
    with Pipeline("source.duration_s=600", "source.faults=[]", "stamps=true", level=level, rate_hz=rate_hz) as pipeline:
        latencies = Recording(pipeline.command("echo", "voter_output", "--json", "--domain", pipeline.domain, *pipeline.with_keys()),
                              pipeline.environment, parse_latency_us)
        try:
            pipeline.until_running()
            first_voted_s = pipeline.plain.samples[0].arrival_s - pipeline.launched_s
            pipeline.until_frame(SETTLED_FRAMES)
            first, cpu_s = len(latencies.samples), processor_s(pipeline)
            pipeline.until_frame(SETTLED_FRAMES + MEASURED_FRAMES)
            cpu_s = processor_s(pipeline) - cpu_s
            measured = sorted(latencies.samples[first:])
        finally:
            latencies.stop()
        missing = pipeline.finish()["voted"]["missing"]
    return first_voted_s, measured, 1e3 * cpu_s / MEASURED_FRAMES, missing


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=at_least_once, default=5)
    parser.add_argument("--rate", type=at_least_once, default=100, help="frames per second")
    options = parser.parse_args()
    ask_for_priority()
    rounds = {level: [] for level in LEVELS}
    for _ in range(options.rounds):
        for level in LEVELS:
            rounds[level].append(measure(level, options.rate))
    print("| level | first voted frame [s] | latency p50 [us] | p99 [us] | CPU time a frame, all services [ms] | voted frames missing |\n|---|---|---|---|---|---|")
    for level, runs in rounds.items():
        p50, p99 = ([run[1][int(len(run[1]) * part)] for run in runs] for part in (0.5, 0.99))
        print(f"| {level} | {statistics.median(run[0] for run in runs):.2f} | {statistics.median(p50):.0f} | {statistics.median(p99):.0f} | "
              f"{statistics.median(run[2] for run in runs):.2f} | {sum(run[3] for run in runs)} |")
    print(f"\nMedians of {options.rounds} runs of each level in turns, {options.rate} Hz, {os.cpu_count()} processors, {MEASURED_FRAMES} frames in each.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
