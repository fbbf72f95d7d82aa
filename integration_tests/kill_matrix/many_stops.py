"""Stops the stronger voter again and again, and lists each sample with which a plain reader of `voted` does not go forward.

`python3 -m integration_tests.kill_matrix.many_stops --stops 1000 [--stopped-s 2] [--reader fastdds] [--both] [--seed N]`: about 0.25 s and the stop itself for
each. A stop is longer than the lease, so that the weaker voter takes over, and finds the stronger one anywhere: also between its decision about a
frame and the write. With `--both` the weaker voter is stopped for the same time, as where a whole machine stands still: then nobody takes over.
"""
import argparse
import random
import sys
import time

from integration_tests.harness.judge import first_judged, gaps, steps_back
from integration_tests.harness.pipeline import Pipeline, ask_for_priority, at_least_once

BETWEEN_S = (0.25, 0.26)  # long enough for the stronger voter to write again


def play(stops, stopped_s, reader, victims, chance):
    """@returns what the reader received, when each stop began and ended, and the frames that the reader lacks after each other"""
    times = []
    with Pipeline("source.duration_s=3600", "source.faults=[]", plain_vendor=reader) as pipeline:
        pipeline.until_running()
        pipeline.until_frame(400)
        for _ in range(stops):
            begin_s = time.monotonic()
            pipeline.stop_for(victims, chance.uniform(0.75 * stopped_s, stopped_s))
            times.append((begin_s, time.monotonic()))
            time.sleep(chance.uniform(*BETWEEN_S))
        pipeline.finish()
        samples = list(pipeline.plain.samples)
        truth = {sample.identity: sample for sample in pipeline.truth.samples}
        return samples, times, [length for _, length in gaps(samples, truth, first_judged(samples), pipeline.end)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--stops", type=at_least_once, default=100)
    parser.add_argument("--stopped-s", type=float, default=0.2, help="longest stop")
    parser.add_argument("--reader", choices=("cyclonedds", "fastdds"), default="cyclonedds", help="whose reader")
    parser.add_argument("--both", action="store_true", help="both voters at once")
    parser.add_argument("--seed", type=int, default=random.randrange(1 << 30))
    options = parser.parse_args()
    ask_for_priority()
    victims = ("voter-1", "voter-2") if options.both else ("voter-1",)
    samples, times, lacking = play(options.stops, options.stopped_s, options.reader, victims, random.Random(options.seed))
    found = steps_back(samples, samples[-1].identity, lambda sample: 0)
    takeovers = sum(now.voter == 2 != before.voter for before, now in zip(samples, samples[1:]))
    print(f"{options.stops} stops (seed {options.seed}), {takeovers} take-overs, {len(samples)} samples, {len(found)} that do not go forward, "
          f"{sum(lacking)} frames lacking in {len(lacking)} gaps, {max(lacking, default=0)} at most in one")
    for now, before in found:
        begin_s, end_s = max((stop for stop in times if stop[0] < now.arrival_s), default=times[0])
        print(f"frame {now.identity[1]} of voter-{now.voter} behind frame {before.identity[1]} of voter-{before.voter}, "
              f"{now.arrival_s - begin_s:.3f} s after a stop and {now.arrival_s - end_s:+.3f} s from its end")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
