"""When a pipeline counts as steady again."""
STEADY_FRAMES = 60


class Steady:
    """A condition for until(): since it was made, each of these voters has published STEADY_FRAMES good samples in a row."""

    def __init__(self, samples, good, voters=(1, 2)):
        """@param samples  of all voters, in the order of their arrival; it grows."""
        self.samples, self.good = samples, good
        self.seen = len(samples)
        self.runs = dict.fromkeys(voters, 0)

    def __call__(self):
        while self.seen < len(self.samples):
            sample = self.samples[self.seen]
            self.seen += 1
            if sample.voter in self.runs:
                self.runs[sample.voter] = self.runs[sample.voter] + 1 if self.good(sample) else 0
        return all(run >= STEADY_FRAMES for run in self.runs.values())
