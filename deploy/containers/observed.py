"""What the observer received: lines `TOPIC {sample}`, in the order of each topic."""
import json
import math

FULL, DEGRADED, SINGLE, COASTING, LOST = range(1, 6)
LEVEL_NAMES = {FULL: "FULL", DEGRADED: "DEGRADED", SINGLE: "SINGLE", COASTING: "COASTING", LOST: "LOST"}


def angle_between(p, q):
    """Geodesic angle of two attitudes [rad]; accurate for small angles, where acos is not."""
    w = sum(a * b for a, b in zip(p, q))
    x = p[0] * q[1] - p[1] * q[0] - p[2] * q[3] + p[3] * q[2]
    y = p[0] * q[2] - p[2] * q[0] - p[3] * q[1] + p[1] * q[3]
    z = p[0] * q[3] - p[3] * q[0] - p[1] * q[2] + p[2] * q[1]
    return 2 * math.atan2(math.sqrt(x * x + y * y + z * z), abs(w))


class Trace:
    def __init__(self, lines):
        self.voted, self.outputs, self.truth, self.events, self.unreadable = [], {}, {}, [], 0
        for line in lines:
            topic, _, text = line.partition(" ")
            try:
                sample = json.loads(text)
            except json.JSONDecodeError:
                self.unreadable += topic in ("voted", "voter_output", "truth", "event")
                continue
            if topic == "voted":
                self.voted.append(sample)
            elif topic == "voter_output":
                self.outputs.setdefault(sample["voter"], []).append(sample)
            elif topic == "truth":
                self.truth[sample["sequence_number"]] = sample
            elif topic == "event":
                self.events.append(sample)

    def newest(self):
        """The newest frame that a voter published; None before the first."""
        return max((samples[-1]["sequence_number"] for samples in self.outputs.values()), default=None)

    def latest(self, voter):
        return self.outputs[voter][-1] if self.outputs.get(voter) else None

    def between(self, voter, first, last):
        return [sample for sample in self.outputs.get(voter, []) if first <= sample["sequence_number"] <= last]

    def missing(self, first, last):
        """Frames that no voter published."""
        published = {sample["sequence_number"] for samples in self.outputs.values() for sample in samples}
        return sorted(set(range(first, last + 1)) - published)

    def longest_gap_of_voted(self, first, last):
        """The largest run of frames without a sample of the owned topic."""
        frames = sorted({first, last} | {sample["sequence_number"] for sample in self.voted if first <= sample["sequence_number"] <= last})
        return max(after - before for before, after in zip(frames, frames[1:])) - 1

    def error_rad(self, sample):
        truth = self.truth.get(sample["sequence_number"])
        return angle_between(sample["attitude"], truth["attitude"]) if truth else None

    def level_steps(self, voter, first, last):
        """`[(sequence, level)]` of every change, the first sample's level included."""
        steps = []
        for sample in self.between(voter, first, last):
            if not steps or steps[-1][1] != sample["level"]:
                steps.append((sample["sequence_number"], sample["level"]))
        return steps
