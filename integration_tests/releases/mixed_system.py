"""A running system of this machine's Debian release, of which processes move to the other release, in the root of `deploy/release-root`.

`python3 -m integration_tests.releases.mixed_system kills`, `… upgrade`, `… sensor`: a table of what was done, and what it cost."""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import time
from typing import NamedTuple

from integration_tests.harness.debian import own_release
from integration_tests.harness.judge import FINAL_ERROR_RAD, errors_beyond, first_judged, judge, missing_frames
from integration_tests.harness.pipeline import ALL_LANES, END_OF_GRACE_FRAMES, RATE_HZ, NotInTime, Pipeline, ask_for_priority
from integration_tests.harness.processes import BIN, CONFIGURATIONS, ROOT, children_of, words_of
from integration_tests.harness.quaternion import angle, conjugate, product
from integration_tests.harness.steady import Steady
from integration_tests.harness.streams import HELD, SINGLE
from integration_tests.kill_matrix.run_cell import lease_frames

OTHER = {"bookworm": "trixie", "trixie": "bookworm"}
RETURN_TIMEOUT_S = 40  # a command in the root begins some seconds later than on the machine itself
FAULTY_AXIS = 1
VOTERS = (1, 2)  # wire ids
LANES = "abc"
STATED = [0.5, -0.5, 0.5, 0.5]  # the attitude that an operator states after a restart of the sensor


def caches():
    return pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "quorient/releases"


def absence(scenario):
    """@returns why no process of the other release can be started here; None where all that the scenario moves can."""
    other = OTHER.get(own_release())
    if other is None:
        return f"'{own_release()}' is not a supported release"
    if os.geteuid() != 0:
        return "a root of another release needs root"
    programs = caches() / other / "build/release/bin"
    absent = [name for name in MOVES[scenario] if not (programs / name).exists()]
    return f"no {', '.join(absent)} of {other} in {programs}: deploy/release-root {other} deploy/demo builds them" if absent else None


class Aligned(NamedTuple):
    """An epoch whose attitude was stated: as of this frame it is STATED."""
    epoch: int
    frame: int

    def broken(self, samples, truths, last):
        """Yields a sentence for each promise that does not hold in this epoch. @param last  the last frame of the run that is judged"""
        true = {truth.identity[1]: truth.attitude for truth in truths if truth.identity[0] == self.epoch}
        voted = [sample for sample in samples if sample.identity[0] == self.epoch]
        if any(sample.level not in HELD and sample.identity[1] < self.frame for sample in voted):
            yield "an attitude was claimed before it was stated"
        missing = missing_frames(voted, {(self.epoch, sequence): None for sequence in true}, (self.epoch, self.frame),
                                 min(last, (self.epoch, max(true) - END_OF_GRACE_FRAMES)))
        if missing:
            yield f"{len(missing)} voted frames missing after the attitude was stated"
        turned = {sequence: product(conjugate(true[self.frame]), attitude) for sequence, attitude in true.items()}
        errors = [angle(sample.attitude, product(STATED, turned[sample.identity[1]])) for sample in voted
                  if sample.identity[1] >= self.frame and sample.identity[1] in turned and sample.level not in HELD]
        if not errors:
            yield "no attitude was voted after it was stated"
        elif max(errors) > FINAL_ERROR_RAD:
            yield f"{max(errors):.1e} rad off the stated attitude, {FINAL_ERROR_RAD:.0e} allowed"


class MixedPipeline(Pipeline):
    """The default demo, started on this release."""

    own, other = own_release(), OTHER.get(own_release())

    def __init__(self, moves_sensor):
        """@param moves_sensor  it is then started beside `quorient launch`, which ends with its own sensor"""
        super().__init__("source.duration_s=600", "source.faults=[]", without=("sensor",) if moves_sensor else ())
        self.steps = []
        self.aligned = []
        self.broken = []
        if moves_sensor:
            demo = str(CONFIGURATIONS / "demo.yaml")
            self.start_on(self.own, ["quorient-sensor", demo, "--name", "sensor", "--domain", str(self.domain), *self.settings])

    def process_of(self, name):
        """As of any pipeline; of a process in the root, the program itself instead of the command that made the root."""
        process = super().process_of(name)
        return process and next((each for each in self._with_descendants(process) if self._members_of(each) == [name]), None)

    @classmethod
    def _with_descendants(cls, process):
        yield process
        for child in children_of(process):
            yield from cls._with_descendants(child)

    def release_of(self, name):
        """By the root folder of the process itself."""
        folder = pathlib.Path(os.readlink(f"/proc/{self.process_of(name)}/root"))
        return self.other if folder == caches() / self.other / "root" else self.own

    def start_on(self, release, words):
        """@param words  a process' command line, of either release"""
        program, *arguments = (word.removeprefix(f"{ROOT}/") for word in words)  # the sources are the working folder on both
        name = arguments[arguments.index("--name") + 1]
        program = pathlib.Path(program).name
        command = [str(BIN / program), *arguments]
        if release != self.own:
            command = [str(ROOT / "deploy/release-root"), "--host-network", release, f"build/release/bin/{program}", *arguments]
        with (self.run_directory / f"{name}.log").open("a") as log:
            self.started_again.append(
                subprocess.Popen(command, cwd=ROOT, env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log))
        self.until(lambda: self.process_of(name), f"{name} runs on {release}", RETURN_TIMEOUT_S)
        if self.release_of(name) != release:
            self.broken.append(f"{name} runs on {self.release_of(name)} in place of {release}")

    def step(self, what, action):
        """Does something to the running system, waits until all lanes are behind both voters' output, and notes what it cost."""
        seen = len(self.merged.samples)
        since = self.merged.newest.identity
        began_s = time.monotonic()
        action()
        if self.aligned and self.aligned[-1].epoch > since[0]:
            since = (self.aligned[-1].epoch, 0)
        self.until(Steady(self.merged.samples, has_all_lanes, VOTERS), "all lanes are back", RETURN_TIMEOUT_S)
        until = self.merged.newest.identity
        alone = {sample.identity for sample in self.merged.samples[seen:] if sample.vouching != ALL_LANES}
        truth = {sample.identity: sample for sample in self.truth.samples}
        missing = missing_frames(self.merged.samples, truth, max(since, first_judged(self.merged.samples)), min(until, self._received()))
        self.steps.append((what, until[1] - since[1], len(alone), len(missing), f"{time.monotonic() - began_s:.1f}"))

    def _received(self):
        """The newest frame that the listeners cannot still be waiting for."""
        epoch, sequence = self.truth.newest.identity
        return (epoch, sequence - self.rate_hz // 4)

    def move(self, release, *names):
        """As deploy/README says: ends these processes in order, and starts them on this release."""
        commands = [self.terminate(name) for name in names]
        for words in commands:
            self.start_on(release, words)

    def move_sensor(self, release):
        """Begins an epoch whose attitude is unknown, and states it after half a second."""
        before = self.truth.newest.identity[0]
        self.move(release, "sensor")
        self.until(lambda: self._is_voted_behind(before), "the new epoch is voted", RETURN_TIMEOUT_S)
        result = self.run("reset", "--attitude", ",".join(map(str, STATED)))
        frames = {int(frame) for frame in re.findall(r"attitude reset by command as of sequence (\d+)", result.stdout)}
        if result.returncode != 0 or len(frames) != 1:
            raise NotInTime(f"reset: {result.stdout}{result.stderr}")
        self.aligned.append(Aligned(self.truth.newest.identity[0], frames.pop()))

    def _is_voted_behind(self, epoch):
        newest = self.merged.newest.identity
        return newest[0] > epoch and newest[1] > self.rate_hz // 2

    def kill_and_start_again(self, name):
        """A process on the other release, of which `quorient launch` knows nothing."""
        process = self.process_of(name)
        words = words_of(process)
        self.kill(name)
        self.until(lambda: self.is_gone(process), f"{name} is gone", 5)
        self.start_on(self.other, words)


def has_all_lanes(sample):
    return sample.vouching == ALL_LANES and sample.excluded == 0 and sample.level <= SINGLE


def kills(system):
    """One lane of the other release; each lane is killed in turn, then a voter; in the end every lane isolates a fault."""
    system.step(f"lane b starts on {system.other}", lambda: system.move(system.other, "fdi-b", "attitude-b"))
    system.step("`attitude-b` is killed there", lambda: system.kill_and_start_again("attitude-b"))
    system.step("`fdi-b` is killed there", lambda: system.kill_and_start_again("fdi-b"))
    system.step("`attitude-a` is killed here", lambda: system.kill("attitude-a"))
    system.step("`voter-1` is killed here", lambda: system.kill("voter-1"))
    system.step("axis 1 measures too little", lambda: isolate(system))


def isolate(system):
    result = system.run("inject", f"axis={FAULTY_AXIS},kind=scale,value=0.8,start=0")
    if result.returncode != 0:
        raise NotInTime(f"inject: {result.stderr}")
    system.until(lambda: system.merged.newest.isolated == 1 << FAULTY_AXIS, "the axis is isolated", 10)


def upgrade(system):
    """Lane by lane, then the standby voter, the owner last; and all the way back."""
    for release in (system.other, system.own):
        for lane in LANES:
            system.step(f"lane {lane} to {release}", lambda: system.move(release, f"fdi-{lane}", f"attitude-{lane}"))
        for voter in reversed(VOTERS):
            system.step(f"`voter-{voter}` to {release}", lambda: system.move(release, f"voter-{voter}"))


def sensor(system):
    for release in (system.other, system.own):
        system.step(f"`sensor` to {release}", lambda: system.move_sensor(release))


SCENARIOS = {"kills": kills, "upgrade": upgrade, "sensor": sensor}
MOVES = {"kills": ("quorient-fdi", "quorient-attitude"), "upgrade": ("quorient-fdi", "quorient-attitude", "quorient-voter"),
         "sensor": ("quorient-sensor",)}


def run(name):
    """@returns the steps, the figures, and a sentence for each promise that did not hold."""
    with MixedPipeline(name == "sensor") as system:
        try:
            system.until_running()
            system.step("start", lambda: None)
            since = system.merged.newest.identity
            SCENARIOS[name](system)
        except NotInTime as problem:
            logs = "".join(f"\n--- {each.stem}\n{each.read_text()[-600:]}" for each in sorted(system.run_directory.glob("*.log")))
            return system.steps, None, [f"{problem}{logs}"]
        summary = system.finish()
        faulty = 1 << FAULTY_AXIS if name == "kills" else 0
        samples = (recording.samples for recording in (system.merged, system.plain, system.truth))
        figures = judge(*samples, summary, since, system.end, faulty, VOTERS, has_all_lanes)
        return system.steps, figures, list(bounds_broken(system, figures, summary, faulty))


def bounds_broken(system, figures, summary, faulty):
    yield from system.broken
    for epoch in system.aligned:
        yield from epoch.broken(system.merged.samples, system.truth.samples, system.end)
    if figures.missing and not system.aligned:
        yield f"{figures.missing} voted frames missing"
    if figures.disordered:
        yield f"{figures.disordered} samples out of order"
    if figures.wrong_isolations:
        yield f"{figures.wrong_isolations} wrong isolations"
    allowed = lease_frames(RATE_HZ)
    if figures.plain_gap > allowed and not system.aligned:  # at the end of voter-1
        yield f"a plain subscriber misses {figures.plain_gap} frames, {allowed} allowed"
    yield from errors_beyond(figures, faulty)
    for lane, seen in summary["lanes"].items():
        if seen["isolated"] != ([FAULTY_AXIS] if faulty else []):
            yield f"lane {lane} isolated {seen['isolated']}"


def table(steps, figures):
    header = ("step", "frames until all lanes are back", "of these with fewer lanes", "frames missing", "time [s]")
    rows = [header, ("---",) * len(header), *steps]
    text = "\n".join("| " + " | ".join(map(str, row)) + " |" for row in rows)
    if figures:
        text += (f"\n\n{figures.frames} frames: {figures.missing} missing, longest gap of a plain reader {figures.plain_gap} frames, "
                 f"largest error {figures.largest_error_rad:.1e} rad, final {figures.final_error_rad:.1e} rad, "
                 f"{figures.wrong_isolations} wrong isolations.")
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenario", choices=SCENARIOS)
    scenario = parser.parse_args().scenario
    reason = absence(scenario)
    if reason:
        print(f"skipped: {reason}", file=sys.stderr)
        return 77
    ask_for_priority()
    steps, figures, broken = run(scenario)
    print(table(steps, figures))
    print("\n".join(broken) or "holds")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
