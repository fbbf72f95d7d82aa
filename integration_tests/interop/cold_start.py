"""Starts the demo many times with plain readers of `voted` beside it, and counts what they are given twice, out of order, or not at all.

    python3 -m integration_tests.interop.cold_start --starts 100                # a table for each order of starting
    python3 -m integration_tests.interop.cold_start --starts 10 --only earlier
    python3 -m integration_tests.interop.cold_start --starts 50 --kill          # the stronger voter dies within the first half second

A reader is an example of idl/examples: the vendor's API, none of our code."""
import argparse
import sys
import time
from typing import NamedTuple

from integration_tests.harness.foreign import BIN, InteropTest, consumer
from integration_tests.harness.pipeline import ask_for_priority, at_least_once
from integration_tests.harness.processes import CONFIGURATIONS, children_of, words_of
from integration_tests.interop.examples_test import samples

DURATION_S = 5  # the vendors have found each other within 2 s
READERS = ("consumer_cyclonedds", "consumer_fastdds")
ORDERS = ("together", "earlier", "later")
KILLED_WITHIN_S = 0.5  # of the first voted frame
TAKE_OVER_FRAMES = 14  # one lease of 50 ms + 20 ms, at 200 Hz


class Given(NamedTuple):
    """What one reader was given in one start."""

    samples: int
    repeated: int  # or older than one before
    missing: int  # between the first sample and the last
    voters: int  # whose samples it was given
    voter_at_kill: int = 0  # whose samples it was given when the stronger voter was killed; 0: none yet
    after_kill: int = 0  # samples

    @property
    def taken_over(self):
        return self.after_kill > 0 and self.missing <= TAKE_OVER_FRAMES

    @property
    def whole(self):
        return self.samples > 0 and self.repeated == 0 and self.missing == 0


def judged(stream):
    """A repetition of the last attitude, while no frames come, has an output sequence of its own."""
    newest, repeated, missing = None, 0, 0
    for sample in stream:
        if newest is not None and sample.output_sequence <= newest.output_sequence:
            repeated += 1
            continue
        if newest is not None and sample.epoch == newest.epoch:
            missing += max(0, sample.sequence - newest.sequence - 1)
        newest = sample
    return Given(len(stream), repeated, missing, len({sample.voter for sample in stream}))


class Start(InteropTest):
    """One start; a test case for its run directory, its domain and its ends of processes."""

    def runTest(self):
        pass

    def given(self, order, kill_after_s=None):
        """@param kill_after_s  so long after the first voted frame the stronger voter is killed  @returns {reader: Given}"""
        if order == "earlier":
            readers = self.start_readers()
            time.sleep(1)  # no synchronisation: it is what is tried
        launch, said = self.start_logged("launch", BIN / "quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--json",
                                         "--set", f"source.duration_s={DURATION_S}", "--set", "source.faults=[]", "--set", "expect=null")
        if order == "later":
            self.eventually(self.frames_are_voted, "frames are voted")
        if order != "earlier":
            readers = self.start_readers()
        if kill_after_s is not None:
            self.eventually(self.frames_are_voted, "frames are voted")
            time.sleep(kill_after_s)  # no synchronisation: it is what is tried
            self.kill(next(child for child in children_of(launch.pid) if "voter-1" in words_of(child)))
            before = {name: samples(log) for name, (_, log) in readers.items()}
        self.assertIn(launch.wait(60), (0,) if kill_after_s is None else (0, 1), said.read_text())
        for process, _ in readers.values():
            process.terminate()
            process.wait(10)
        given = {name: judged(samples(log)) for name, (_, log) in readers.items()}
        if kill_after_s is None:
            return given
        return {name: one._replace(voter_at_kill=before[name][-1].voter if before[name] else 0, after_kill=one.samples - len(before[name]))
                for name, one in given.items()}

    def frames_are_voted(self):
        beat = self.heartbeat("voter-1")
        return beat.exists() and beat.read_text().split()[1:2] > ["0"]

    def start_readers(self):
        return {name: self.start_logged(name, *consumer(name), self.domain) for name in READERS}


def start(order, kill_after_s=None):
    one = Start()
    one.setUp()
    try:
        return one.given(order, kill_after_s)
    finally:
        one.tearDown()


def report(order, outcomes):
    for name in READERS:
        given = [outcome[name] for outcome in outcomes]
        yield (f"| {order} | {name} | {sum(one.whole for one in given)} of {len(given)} | {sum(one.repeated > 0 for one in given)} "
               f"| {max(one.repeated for one in given)} | {sum(one.missing > 0 for one in given)} | {max(one.missing for one in given)} "
               f"| {sum(one.voters > 1 for one in given)} |")


KILLED_HEADER = """| reader | voter that it had when the stronger one died | at most one lease + 20 ms missed, and served after that | most frames missed |
|---|---|---|---|"""
HAD = {1: "the stronger", 2: "the weaker", 0: "none yet"}


def kill_many(starts):
    """The stronger voter is killed at times spread evenly over the first half second. @returns whether all readers had the other in time"""
    outcomes = [start("together", KILLED_WITHIN_S * (number + 0.5) / starts) for number in range(starts)]
    print(KILLED_HEADER)
    for name in READERS:
        for voter, words in HAD.items():
            given = [outcome[name] for outcome in outcomes if outcome[name].voter_at_kill == voter]
            if given:
                print(f"| {name} | {words} | {sum(one.taken_over for one in given)} of {len(given)} | {max(one.missing for one in given)} |")
    return all(one.taken_over for outcome in outcomes for one in outcome.values())


HEADER = """| readers start | reader | every frame once, in order | starts with repeated frames | most of them | starts with missing frames | most of them | starts with both voters |
|---|---|---|---|---|---|---|---|"""


def start_many(starts, orders):
    """@returns whether all readers were given every frame once"""
    print(HEADER, flush=True)
    whole = True
    for order in orders:
        outcomes = [start(order) for _ in range(starts)]
        whole = whole and all(one.whole for outcome in outcomes for one in outcome.values())
        print("\n".join(report(order, outcomes)), flush=True)
    return whole


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--starts", type=at_least_once, default=20)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--only", choices=ORDERS, help="one order of starting")
    what.add_argument("--kill", action="store_true", help="kill the stronger voter within the first half second")
    options = parser.parse_args()
    for name in READERS:
        consumer(name)
    ask_for_priority()
    whole = kill_many(options.starts) if options.kill else start_many(options.starts, (options.only,) if options.only else ORDERS)
    print(f"\nMade by `python3 -m integration_tests.interop.cold_start {' '.join(sys.argv[1:])}`.")
    return 0 if whole else 1


if __name__ == "__main__":
    sys.exit(main())
