"""Figures of a run, from the recorded topics and the simulator's truth."""
from dataclasses import dataclass, field

from integration_tests.harness.quaternion import angle
from integration_tests.harness.streams import HELD

FINAL_ERROR_RAD = 1e-5


@dataclass
class Figures:
    frames: int = 0
    missing: int = 0  # frames of the publisher that the merged stream never answered
    plain_gap: int = 0  # largest run of frames that a plain subscriber of `voted` did not see
    steps_back: list = field(default_factory=list)  # (sample, the one before): output_sequence did not increase, of one voter or in the plain stream
    largest_error_rad: float = 0
    final_error_rad: float = 0
    contamination_rad: float = 0  # what the fault can do to the attitude in one frame
    wrong_isolations: int = 0
    frames_to_isolation: int = 3
    frames_to_full: int = None
    outside_sigmas: int = 0  # bridged attitudes whose error is above 1e-5 rad and five of their standard deviations
    claims: int = 0  # frames of a later epoch with a level that claims to know the attitude
    levels: set = field(default_factory=set)

    @property
    def disordered(self):
        return len(self.steps_back)


def errors(samples, truth):
    """(identity, error, sample) of every sample that stands for a frame of its own."""
    for sample in samples:
        true = truth.get(sample.identity)
        if true is not None and sample.level not in HELD:
            yield sample.identity, angle(sample.attitude, true.attitude), sample


def missing_frames(samples, truth, first, end):
    answered = {sample.identity for sample in samples}
    return sorted(identity for identity in truth if first <= identity <= end and identity not in answered)


def first_judged(samples):
    """Until half a second after the start a listener that starts with the system may have found one voter and not yet the other."""
    epoch, sequence = samples[0].identity
    return (epoch, max(sequence, 100))


def gaps(samples, truth, first, end):
    """(first identity, length) of every run of consecutive frames of the publisher without a sample."""
    missing = set(missing_frames(samples, truth, first, end))
    runs, run = [], []
    for identity in sorted(truth):
        if identity in missing:
            run.append(identity)
        elif run:
            runs.append((run[0], len(run)))
            run = []
    return runs + ([(run[0], len(run))] if run else [])


def largest_gap(samples, truth, first, end):
    return max((length for _, length in gaps(samples, truth, first, end)), default=0)


def steps_back(samples, end, key):
    """(sample, the one before it with the same key) wherever output_sequence does not increase."""
    last, found = {}, []
    for sample in samples:
        if sample.identity > end:
            continue
        before = last.get(key(sample))
        if before and sample.output_sequence <= before.output_sequence:
            found.append((sample, before))
        last[key(sample)] = sample
    return found


def disordered(samples, end, key):
    return len(steps_back(samples, end, key))


def frames_until(samples, since, condition, steady=20):
    """Frames from `since` until the condition holds for so many different frames in a row; None = never."""
    run = 0
    for sample in samples:
        if sample.identity[0] < since[0] or sample.identity <= since:
            continue
        run = run + 1 if condition(sample) else 0
        if run >= steady:
            return sample.identity[1] - steady + 1 - (since[1] if sample.identity[0] == since[0] else 0)
    return None


def judge(merged, plain, truths, summary, since, end, faulty, voters, full):
    """@param since identity at the action, end the last frame judged, faulty mask of axes that may be isolated, voters the ones that run
    at the end, full predicate: whether a sample shows that all processes are back."""
    truth = {sample.identity: sample for sample in truths}
    figures = Figures(frames=len(truth), levels={sample.level for sample in merged if sample.arrival_s})
    first = first_judged(merged)
    own_missing = len(missing_frames(merged, truth, first, end))
    # A frame that either of two listeners received was published. Within one epoch the launch's own count is a second bound.
    one_epoch = len({identity[0] for identity in truth}) == 1
    figures.missing = min(own_missing, summary["voted"]["missing"]) if one_epoch else own_missing
    figures.plain_gap = largest_gap(plain, truth, first_judged(plain), end)
    figures.steps_back = steps_back(merged, end, lambda sample: sample.voter) + steps_back(plain, end, lambda sample: 0)

    judged = [(identity, error, sample) for identity, error, sample in errors(merged, truth) if identity[0] == since[0]]
    figures.largest_error_rad = max(error for _, error, _ in judged)
    figures.final_error_rad = max(judged)[1]
    # After the action, where the standard deviation states how uncertain the bridged motion is.
    after = [entry for entry in judged if entry[0] > since]
    figures.outside_sigmas = sum(error > max(5 * sample.sigma_rad, 1e-5) for _, error, sample in after)
    figures.claims = sum(sample.identity[0] > since[0] and sample.level not in HELD for sample in merged)

    ordered = sorted(identity for identity in truth if identity[0] == since[0])
    steps = [angle(truth[a].attitude, truth[b].attitude) for a, b in zip(ordered, ordered[1:]) if b[1] == a[1] + 1]
    figures.contamination_rad = 0.2 * max(steps)  # the scale fault takes a fifth of the axis' rate
    seen = [mask for lane in summary["lanes"].values() for mask in lane["isolated"]]
    figures.wrong_isolations = sum(not faulty >> axis & 1 for axis in seen)
    figures.wrong_isolations += sum(bool(sample.isolated & ~faulty) for sample in merged)
    frames = [lane["frames_to_isolation"] for lane in summary["lanes"].values() if lane["frames_to_isolation"]]
    figures.frames_to_isolation = min(max(frames, default=3), 3)
    until = [frames_until([sample for sample in merged if sample.voter == voter], since, full) for voter in voters]
    figures.frames_to_full = None if None in until else max(until)
    return figures


def errors_beyond(figures, has_fault):
    """Yields a sentence for each error of the attitude beyond its bound: what the faulty axis adds until it is isolated counts on top."""
    allowed_rad = FINAL_ERROR_RAD + ((figures.frames_to_isolation + 1) * figures.contamination_rad if has_fault else 0)
    if figures.largest_error_rad > allowed_rad:
        yield f"largest error {figures.largest_error_rad:.2e} rad, {allowed_rad:.2e} allowed"
    if figures.final_error_rad > FINAL_ERROR_RAD:
        yield f"final error {figures.final_error_rad:.2e} rad, {FINAL_ERROR_RAD:.0e} allowed"
