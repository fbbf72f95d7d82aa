"""Kills and faults at random, with a seed, and checks what the pipeline promises all the time.

`python3 -m integration_tests.soak --minutes 10` from the source root, on the release build. Exits 0 only if every invariant held. The seed is
printed; with --seed the same kills and faults come in the same order."""
import argparse
import random
import signal
import sys
import time

from integration_tests.harness.judge import FINAL_ERROR_RAD, disordered, errors, first_judged, gaps, missing_frames
from integration_tests.harness.pipeline import ALL_LANES, LEVELS, RATE_HZ, NotInTime, Pipeline, ask_for_priority, at_least_once, rate_between
from integration_tests.harness.resources import memory_and_descriptors
from integration_tests.harness.steady import Steady
from integration_tests.harness.streams import SINGLE
from integration_tests.harness.witness import NoQuietMachine, until_held

AXES = 4
# All by the vector predictor: the modulus predictor of the demo's third lane rightly calls some faults ambiguous, and stays there.
LANES = "lanes=[{name: a, detector: {method: vector}}, {name: b, dds: fastdds, detector: {method: vector}}, {name: c, detector: {method: vector}}]"
VICTIMS = ("fdi-a", "fdi-b", "fdi-c", "attitude-a", "attitude-b", "attitude-c", "voter-1", "voter-2")
SIGNALS = ("kill", "stop")
STOPPED_S = 0.5
BACK_WITHIN_S = 15
ERROR_RAD_S = 0.2  # largest in an interval: three frames of the largest fault here and what leaves with it
LEASE_S = 0.07  # a lease of `voted`, max(50 ms, 3 intervals), and 20 ms
GROWTH_MIB = 8
SKIPPED = 77  # as ctest knows it
FRAMES_TO_TRUST = 10  # an axis must agree with the others in eight frames (fdi::FourAxisDetector::release_frames)
STANDBY_S = 2.5  # the weaker voter owns nothing before it has received the stronger one's output, or for 2 s (voting::VoterSettings::listen_s)


class Soak:
    def __init__(self, pipeline, seed):
        self.pipeline = pipeline
        self.random = random.Random(seed)
        self.kills = 0
        self.isolated = 0
        self.wrong = 0
        self.problems = []

    def back(self, isolated):
        """All lanes stand behind both voters' output, with just these axes isolated."""
        def good(sample):
            return sample.vouching == ALL_LANES and sample.excluded == 0 and sample.level <= SINGLE and sample.isolated == isolated

        self.pipeline.until(Steady(self.pipeline.merged.samples, good), f"all lanes back with {isolated:#06b} isolated", BACK_WITHIN_S)

    def hit(self, act, victim):
        if act == "stop":
            self.pipeline.stop_for((victim,), STOPPED_S)
        else:
            self.pipeline.kill(victim)
        self.kills += 1

    def order(self, *words):
        """An operator's order; it answers with an exit code."""
        result = self.pipeline.run(*words)
        if result.returncode != 0:
            self.problems.append(f"{' '.join(words)}: {result.stdout}{result.stderr}".strip())

    def round(self):
        """One fault, one kill, in random order and distance; then the axis is trusted again."""
        axis = self.random.randrange(AXES)
        act, victim = self.random.choice(SIGNALS), self.random.choice(VICTIMS)
        fault_first = self.random.random() < 0.5
        print(f"{time.strftime('%H:%M:%S', time.gmtime())} axis {axis} fails {'before' if fault_first else 'after'} {act} of {victim}", flush=True)
        if not fault_first:
            self.hit(act, victim)
        self.order("inject", f"axis={axis},kind=bias,value=0.05,start=0,end=1")
        if fault_first:
            self.hit(act, victim)
        self.back(1 << axis)
        self.isolated += 1
        self.pipeline.until(self.healed, "the fault is over", BACK_WITHIN_S)
        self.order("readmit", "--axis", str(axis))
        self.back(0)

    def healed(self):
        """What is still wrong no detector would trust again."""
        return not any(sample.faulty for sample in self.pipeline.truth.samples[-FRAMES_TO_TRUST:])

    def run(self, until_s):
        rounds = 0
        while rounds == 0 or time.monotonic() < until_s:
            self.round()
            rounds += 1
            if self.pipeline.launch.poll() is not None:
                raise NotInTime("the run ended by itself")


def wrong_isolations(merged, truth):
    """Samples that isolate an axis which no fault has touched up to then."""
    touched, faulty_since = 0, {}
    for identity in sorted(truth):
        touched |= truth[identity].faulty
        faulty_since[identity] = touched
    return sum(bool(sample.isolated & ~faulty_since.get(sample.identity, ALL_LANES << 1 | 1)) for sample in merged)


def explain(pipeline, truth, names, missing):
    """When frames went missing, and what the voters said in the seconds around it."""
    wall_s = time.time() - time.monotonic()
    explained_s = None
    for identity in missing:
        at_s = truth[identity].arrival_s + wall_s
        if explained_s is not None and at_s - explained_s < 1:
            continue
        explained_s = at_s
        around = {time.strftime("%H:%M:%S", time.gmtime(at_s + offset)) for offset in (-1, 0, 1)}
        print(f"--- from frame {identity[1]} on, {time.strftime('%H:%M:%S', time.gmtime(at_s))}", file=sys.stderr)
        for name in names:
            for line in pipeline.log_of(name).splitlines():
                if line[:8] in around:
                    print(line, file=sys.stderr)


def conclude(soak, names, before, after):
    pipeline = soak.pipeline
    merged, plain = pipeline.merged.samples, pipeline.plain.samples
    truth = {sample.identity: sample for sample in pipeline.truth.samples}
    judged = sorted((identity, error, sample.sigma_rad) for identity, error, sample in errors(merged, truth) if identity <= pipeline.end)
    unanswered = missing_frames(merged, truth, first_judged(merged), pipeline.end)
    plain_gaps = gaps(plain, truth, first_judged(plain), pipeline.end)
    lease_frames, error_rad = round(LEASE_S * pipeline.rate_hz), ERROR_RAD_S / pipeline.rate_hz
    explain(pipeline, truth, names, sorted(unanswered + [first for first, length in plain_gaps if length > lease_frames]))
    missing = len(unanswered)
    gap = max((length for _, length in plain_gaps), default=0)
    order = disordered(merged, pipeline.end, lambda sample: sample.voter) + disordered(plain, pipeline.end, lambda sample: 0)
    wrong = wrong_isolations(merged, truth)
    (largest, largest_sigma), (final, final_sigma) = max((error, sigma) for _, error, sigma in judged), judged[-1][1:]
    grown = {name: after[name][0] - before[name][0] for name in before if name in after and after[name][2] == before[name][2]}
    descriptors = {name: after[name][1] - before[name][1] for name in grown}
    rows = [
        ("kills and stops survived", soak.kills, "", True),
        ("faults isolated", soak.isolated, "", True),
        ("frames", len(truth), "", True),
        ("voted frames missing", missing, "0", missing == 0),
        ("largest gap of a plain subscriber [frames]", gap, f"<= {lease_frames}", gap <= lease_frames),
        ("samples out of order", order, "0", order == 0),
        ("wrong isolations", wrong, "0", wrong == 0),
        ("largest attitude error, and what it was said to be [rad]", f"{largest:.2e}, {largest_sigma:.1e}", f"<= {error_rad:.0e}", largest <= error_rad),
        ("final attitude error, and what it was said to be [rad]", f"{final:.2e}, {final_sigma:.1e}", f"<= {FINAL_ERROR_RAD:.0e}", final <= FINAL_ERROR_RAD),
        ("memory at start, end [MiB]", f"{sum(v[0] for v in before.values()):.1f}, {sum(v[0] for v in after.values()):.1f}", "", True),
        ("largest growth of a process that lived on [MiB]", f"{max(grown.values(), default=0):.2f}", f"<= {GROWTH_MIB}",
         max(grown.values(), default=0) <= GROWTH_MIB),
        ("descriptors at start, end", f"{sum(v[1] for v in before.values())}, {sum(v[1] for v in after.values())}", "", True),
        ("largest growth of descriptors", max(descriptors.values(), default=0), "<= 8", max(descriptors.values(), default=0) <= 8),
    ]
    print("\n| | measured | bound | |\n|---|---|---|---|")
    for name, value, bound, held in rows:
        print(f"| {name} | {value} | {bound} | {'' if not bound else 'holds' if held else 'BROKEN'} |")
    soak.problems += [name for name, _, _, held in rows if not held]


def soaked(options, seed):
    """@returns whether every invariant held."""
    with Pipeline("source.duration_s=86400", "source.faults=[]", LANES, rate_hz=options.rate, level=options.level) as pipeline:
        soak = Soak(pipeline, seed)
        try:
            pipeline.until_running()
            pipeline.until_frame(STANDBY_S * options.rate)
            soak.back(0)
            before = memory_and_descriptors(pipeline)
            soak.run(time.monotonic() + options.minutes * 60)
        except NotInTime as problem:
            soak.problems.append(str(problem))
            for name in ("voter-1", "voter-2"):
                print(f"--- {name}\n{pipeline.log_of(name)[-3000:]}", file=sys.stderr)
        after = memory_and_descriptors(pipeline)
        names = pipeline.names()
        pipeline.finish()
        if "before" in locals():
            conclude(soak, names, before, after)
    for problem in soak.problems:
        print(f"not held: {problem}")
    print(f"seed {seed}: {'every invariant held' if not soak.problems else 'FAILED'}")
    return not soak.problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10, help="at least one round is run to its end")
    parser.add_argument("--seed", type=int, default=None)
    parser.add_argument("--rate", type=rate_between(60), metavar="HZ", default=RATE_HZ, help="of the system; 60: below, the plain reader's lease is too short")
    parser.add_argument("--level", choices=LEVELS, default="none", help="DDS Security of the demo")
    parser.add_argument("--attempts", type=at_least_once, default=1, help="a run that does not hold is void where the machine stood still meanwhile")
    options = parser.parse_args()
    seed = options.seed if options.seed is not None else random.SystemRandom().randrange(1 << 32)
    print(f"seed {seed}", flush=True)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    ask_for_priority()
    try:
        return 0 if until_held(lambda: soaked(options, seed), options.attempts) else 1
    except NoQuietMachine as reason:
        print(f"skipped: {reason}")
        return SKIPPED


if __name__ == "__main__":
    sys.exit(main())
