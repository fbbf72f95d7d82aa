#!/usr/bin/env python3
"""Breaks a running system of containers in five ways, and judges it by the observer's stream and the simulator's truth.

Bounds are counted in frames (20 ms each), so that a busy machine that delays everything alike changes nothing.
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

from observed import DEGRADED, FULL, LEVEL_NAMES, SINGLE, Trace

COMPOSE_FILE = pathlib.Path(__file__).resolve().parents[1] / "docker-compose.yml"
PROJECT = os.environ["COMPOSE_PROJECT_NAME"]
SERVICES = ["sensor", *(f"{role}-{lane}" for role in ("fdi", "attitude") for lane in "abc"), "voter-1", "voter-2"]
ALL_LANES = 0b111
FAULTY_AXIS = 1

# Bounds, each with its reason.
FRAMES_TO_ISOLATION = 5  # 1 frame to see, 1 to confirm, and the voters' patience
ERROR_RAD = 5.0e-3  # a few frames of a fault of 1e-3 rad a frame, seen before roll-back corrects them
FINAL_ERROR_RAD = 3.0e-4  # the random walk of 1e-6 rad a frame, and frames lost to a cut
TAKE_OVER_FRAMES = 30  # the owner's lease of 0.3 s, and as much again for two busy schedulers
FRAMES_TO_DEGRADED = 100  # ten intervals of silence, and the level's window of ten frames; the rest is the kill itself


def run(*command, check=True, timeout=60):
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=timeout)
    if check and result.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: {result.stdout}{result.stderr}")
    return result


class Containers:
    def __init__(self):
        self.ids = {}
        for name in [*SERVICES, "observer"]:
            self.ids[name] = run("docker-compose", "-f", COMPOSE_FILE, "ps", "-q", name).stdout.strip()
        networks = run("docker", "network", "inspect", f"{PROJECT}_network_a").stdout
        self.bridge_a = "br-" + json.loads(networks)[0]["Id"][:12]

    def inside(self, name, *command, check=True):
        return run("docker", "exec", self.ids[name], *command, check=check)

    def healthy(self, name):
        return self.inside(name, "quorient", "health", name, check=False).returncode == 0

    def process(self, name):
        return int(run("docker", "inspect", "-f", "{{.State.Pid}}", self.ids[name]).stdout)

    def observed(self, tail="all"):
        return Trace(run("docker", "logs", "--tail", tail, self.ids["observer"], timeout=120).stdout.splitlines())

    def observed_by_now(self):
        return self.observed(tail=200)

    def inject(self, fault):
        peers = self.inside("observer", "sed", "-n", r"s/^  - \([0-9][0-9.]*\).*/--peer \1/p", "/etc/quorient/system.yaml").stdout.split()
        self.inside("observer", "quorient", "inject", fault, "--dds", "fastdds", "--interface", "any", "--domain", "42", *peers)

    def cut_network_a(self):
        run("ip", "link", "set", self.bridge_a, "down")

    def heal_network_a(self):
        run("ip", "link", "set", self.bridge_a, "up")


class Verdicts:
    def __init__(self):
        self.passed = self.failed = 0
        self.begin = time.monotonic()

    def check(self, what, good, seen=""):
        self.passed += bool(good)
        self.failed += not good
        print(f"[{time.monotonic() - self.begin:5.1f} s] {'ok  ' if good else 'FAIL'} {what}{f': {seen}' if seen != '' else ''}", flush=True)


def eventually(condition, timeout_s):
    """Polls. @returns whether it came true in time."""
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.1)
    return True


def frames_pass(containers, count, timeout_s=30):
    """Waits for frames of the stream itself, not for a time."""
    start = containers.observed_by_now().newest() or 0
    eventually(lambda: (containers.observed_by_now().newest() or 0) >= start + count, timeout_s)
    return containers.observed_by_now().newest()


def whole(containers):
    """Both voters stand on three lanes."""
    now = containers.observed_by_now()
    return all(now.latest(voter) and now.latest(voter)["level"] == FULL and now.latest(voter)["vouching_mask"] == ALL_LANES for voter in (1, 2))


def steps_text(steps):
    return " -> ".join(f"{LEVEL_NAMES.get(level, level)} at {sequence}" for sequence, level in steps)


def start_up(containers, verdicts):
    good = eventually(lambda: all(containers.healthy(name) for name in SERVICES), 120)
    verdicts.check("every service handles fresh frames", good, [name for name in SERVICES if not containers.healthy(name)] or "")
    verdicts.check("both voters publish FULL, three lanes vouching", eventually(lambda: whole(containers), 20))
    fenced = [
        name for name in SERVICES
        if containers.inside(name, "id", "-u").stdout.strip() == "10001" and containers.inside(name, "touch", "/usr/x", check=False).returncode != 0
    ]
    verdicts.check("no service is root or can write its root file system", fenced == SERVICES, sorted(set(SERVICES) - set(fenced)) or "")


def sensor_fault(containers):
    containers.inject(f"axis={FAULTY_AXIS},kind=bias,value=0.05,start=0.2")
    return frames_pass(containers, 150)


def kill_lane_b(containers, verdicts):
    """As a crash: the processes die, and Docker's restart policy brings them back."""
    start = containers.observed_by_now().newest()
    for name in ("fdi-b", "attitude-b"):
        os.kill(containers.process(name), signal.SIGKILL)
    back = eventually(lambda: containers.healthy("fdi-b") and containers.healthy("attitude-b"), 30)
    verdicts.check("the killed lane is back by itself", back)
    verdicts.check("three lanes vouch again after the kill", eventually(lambda: whole(containers), 30))
    return start, containers.observed_by_now().newest()


def pause_voter_1(containers, verdicts):
    start = containers.observed_by_now().newest()
    run("docker", "pause", containers.ids["voter-1"])
    try:
        frames_pass(containers, 200)
        stale = containers.observed_by_now()
    finally:
        run("docker", "unpause", containers.ids["voter-1"])
    verdicts.check("voter 2 alone publishes while voter 1 is paused", 1 not in {sample["voter"] for sample in stale.voted[-20:]} and stale.voted != [])
    verdicts.check("the paused voter is back", eventually(lambda: containers.healthy("voter-1") and whole(containers), 30))
    return start, containers.observed_by_now().newest()


def cut_network_a(containers, verdicts):
    start = containers.observed_by_now().newest()
    containers.cut_network_a()
    try:
        frames_pass(containers, 200)
    finally:
        containers.heal_network_a()
    verdicts.check("three lanes vouch again after the cut", eventually(lambda: whole(containers), 60))
    return start, containers.observed_by_now().newest()


def stop(containers, verdicts):
    begin = time.monotonic()
    run("docker-compose", "-f", COMPOSE_FILE, "stop", "-t", "5", *SERVICES, timeout=120)
    codes = {name: run("docker", "inspect", "-f", "{{.State.ExitCode}}", containers.ids[name]).stdout.strip() for name in SERVICES}
    verdicts.check(f"every service stops in order, {time.monotonic() - begin:.1f} s", set(codes.values()) == {"0"}, {n: c for n, c in codes.items() if c != "0"} or "")


def judge_isolation(trace, verdicts, first, last):
    onset = next((sequence for sequence in sorted(trace.truth) if trace.truth[sequence]["faulty_mask"]), None)
    verdicts.check("the simulator says when the fault began", onset is not None, onset)
    right = 1 << FAULTY_AXIS
    for voter in (1, 2):
        masks = {sample["isolated_mask"] for sample in trace.between(voter, first, last)}
        named = next((sample["sequence_number"] for sample in trace.outputs[voter] if sample["isolated_mask"] == right), None)
        verdicts.check(f"voter {voter} names axis {FAULTY_AXIS} and no other, ever", masks == {0, right}, f"masks {sorted(masks)}")
        if onset is not None and named is not None:
            verdicts.check(f"voter {voter} names it within {FRAMES_TO_ISOLATION} frames", 0 <= named - onset <= FRAMES_TO_ISOLATION, f"{named - onset} frames")


def judge_stream(trace, verdicts, first, last):
    verdicts.check("every line of the observer is whole", trace.unreadable == 0, trace.unreadable or "")
    missing = trace.missing(first, last)
    verdicts.check(f"no frame of {last - first + 1} lacks a voted attitude", not missing, f"{len(missing)} missing, {missing[:5]}" if missing else "")
    for voter, samples in sorted(trace.outputs.items()):
        numbers = [sample["output_sequence"] for sample in samples]
        verdicts.check(f"voter {voter}'s output only goes forward", all(a < b for a, b in zip(numbers, numbers[1:])))
    errors = [error for voter in (1, 2) for sample in trace.between(voter, first, last) if (error := trace.error_rad(sample)) is not None]
    verdicts.check(f"the attitude stays within {ERROR_RAD} rad of the truth", max(errors) < ERROR_RAD, f"{max(errors):.2e} rad over {len(errors)} samples")
    verdicts.check(f"and ends within {FINAL_ERROR_RAD} rad", errors[-1] < FINAL_ERROR_RAD, f"{errors[-1]:.2e} rad")


def judge_levels(trace, verdicts, what, start, end):
    steps = trace.level_steps(2, start, end)
    fallen = next((sequence for sequence, level in steps if level == DEGRADED), None)
    verdicts.check(f"{what}: FULL, DEGRADED within {FRAMES_TO_DEGRADED} frames, FULL again, never less",
                   steps and steps[0][1] == FULL and steps[-1][1] == FULL and fallen is not None and fallen - start <= FRAMES_TO_DEGRADED
                   and all(level <= SINGLE - 1 for _, level in steps), steps_text(steps))


def save_logs(folder, containers):
    for name in [*SERVICES, "observer"]:
        (folder / f"{name}.log").write_bytes(subprocess.run(["docker", "logs", containers.ids[name]], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120).stdout)


def main():
    folder = pathlib.Path(sys.argv[1])
    containers, verdicts = Containers(), Verdicts()
    try:
        start_up(containers, verdicts)
        first = containers.observed_by_now().newest()
        sensor_fault(containers)
        killed = kill_lane_b(containers, verdicts)
        paused = pause_voter_1(containers, verdicts)
        cut = cut_network_a(containers, verdicts)
        last = frames_pass(containers, 100) - 50  # what is still on its way at the end is not judged
        stop(containers, verdicts)
        trace = containers.observed()
        judge_isolation(trace, verdicts, first, last)
        judge_stream(trace, verdicts, first, last)
        judge_levels(trace, verdicts, "lane b killed", *killed)
        judge_levels(trace, verdicts, "network A cut", *cut)
        for what, (start, end) in (("killing a lane", killed), ("pausing the owner", paused), ("cutting network A", cut)):
            gap = trace.longest_gap_of_voted(start, end)
            verdicts.check(f"{what} leaves at most {TAKE_OVER_FRAMES} frames without the owned topic", gap <= TAKE_OVER_FRAMES, f"{gap} frames")
    except (RuntimeError, subprocess.TimeoutExpired) as problem:
        verdicts.check("the scenario runs to its end", False, problem)
    if verdicts.failed:
        save_logs(folder, containers)
    print(f"{verdicts.passed} passed, {verdicts.failed} failed")
    return 1 if verdicts.failed or not verdicts.passed else 0


if __name__ == "__main__":
    sys.exit(main())
