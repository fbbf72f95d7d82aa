"""The containers of deploy/compose.secured.yaml: keys as read-only files, a lane and the stronger voter killed, a container without keys.

The judge compares what a monitor with keys receives from both voters with the simulator's truth, as scenario.py does. The bounds are its own."""
import argparse
import os
import pathlib
import subprocess
import sys
import time

from integration_tests.containers.containers import COMPOSE_FILE, UID, Containers, peers_of
from integration_tests.containers.observed import parse_event
from integration_tests.containers.private_keys import private_keys_in_image
from integration_tests.containers.scenario import (LANE_B, LEASE_S, PLAIN_GAP_FRAMES, Chapter, Verdicts, conclude, judge_fences, judge_order,
                                                   kill_lane_b, play_all, stop, until, until_settled, until_whole)
from integration_tests.harness.pipeline import NotInTime
from integration_tests.harness.streams import Recording, parse_truth, parse_voted
from integration_tests.harness.witness import Witness

SECURED_FILE = COMPOSE_FILE.parent / "compose.secured.yaml"
SYSTEM_FILE = COMPOSE_FILE.parent / "configurations/compose.secured.yaml"
KEYS = "/etc/quorient/keys"
DOMAIN = 43
VENDORS = ("cyclonedds", "fastdds")
START_S = 90
UNCERTIFIED = "it has no certificate"  # in the event of a service on Fast DDS; Cyclone DDS reports none


class Secured(Containers):
    def __init__(self, project, image, keys):
        super().__init__(project, SECURED_FILE)
        self._image, self._keys = image, keys

    def read(self, name, topic, vendor, parse, keys=True):
        """@returns what another container on the system's network receives, with a monitor's keys or without any, while it arrives."""
        files = [word for part in ("shared", "monitor") for word in ("-v", f"{self._keys}/{part}:{KEYS}/{part}:ro")] if keys else []
        joins = ["--keys", KEYS] if keys else ["--domain", DOMAIN]
        fences = ["--init", "--read-only", "--user", f"{UID}:{UID}", "--cap-drop", "ALL", "--security-opt", "no-new-privileges:true",
                  "--tmpfs", f"/run/quorient:uid={UID},gid={UID}", "--tmpfs", "/tmp"]
        command = ["docker", "run", "--rm", "--name", f"{self.project}-reader-{name}", "--network", f"{self.project}_secured", *fences, *files, self._image,
                   "quorient", "echo", topic, "--json", "--dds", vendor, "--interface", "any", "--participants-per-host", 2, "--lease", LEASE_S, *peers_of(SYSTEM_FILE), *joins]
        return Recording(list(map(str, command)), os.environ, lambda sample, arrival_s: parse(sample | {"arrival_s": arrival_s}))

    def wrong_keys(self):
        """[`service: what`] where a container holds other private keys than its own, or may write what it holds."""
        found = []
        for name, process in self.processes().items():
            folder = pathlib.Path(f"/proc/{process}")
            held = sorted(str(file.relative_to(folder / "root" / KEYS[1:])) for file in (folder / "root" / KEYS[1:]).rglob("*.pem") if file.name == "key.pem")
            mounts = [line.split() for line in (folder / "mountinfo").read_text().splitlines()]
            ours = [mount for mount in mounts if mount[4].startswith(KEYS)]
            if held != [f"{name}/key.pem"]:
                found.append(f"{name}: {held}")
            if len(ours) != 2 or any("ro" not in mount[5].split(",") for mount in ours):
                found.append(f"{name}: mounts {ours}")
        return found


class Seen:
    """What readers with keys receive, for play_all(); what containers without keys receive; and the events. Use as a context."""

    def __init__(self, secured):
        as_voted = lambda sample: parse_voted(sample, sample["arrival_s"])  # noqa: E731
        self._merged = secured.read("merged", "voter_output", "cyclonedds", as_voted)
        self._plain = secured.read("plain", "voted", "fastdds", as_voted)
        self._truth = secured.read("truth", "truth", "cyclonedds", lambda sample: parse_truth(sample, sample["arrival_s"]))
        self._events = secured.read("events", "event", "cyclonedds", parse_event)
        self.outsiders = {vendor: secured.read(f"outsider-{vendor}", "voted", vendor, as_voted, keys=False) for vendor in VENDORS}
        self.merged, self.plain, self.truth, self.events = (recording.samples for recording in self._readers())
        self._witness = Witness()

    def _readers(self):
        return self._merged, self._plain, self._truth, self._events

    def __enter__(self):
        self._witness.__enter__()
        return self

    def __exit__(self, *_):
        for recording in (*self._readers(), *self.outsiders.values()):
            recording.stop()
        self._witness.__exit__()

    def newest(self):
        return self.merged[-1].identity if self.merged else None

    def longest_stall_s(self, _):
        """Since the last question."""
        self._witness.__exit__()
        longest_s, self._witness = self._witness.longest_s, Witness()
        self._witness.__enter__()
        return longest_s


def kill_voter_1(containers):
    containers.kill("voter-1")


def chapters():
    yield Chapter("lane b is killed", kill_lane_b, LANE_B, 0)
    yield Chapter("voter 1, the owner, is killed", kill_voter_1, 0, PLAIN_GAP_FRAMES, (2,))


def start_up(secured, seen, verdicts):
    begin_s = time.monotonic()
    secured.prefer()
    until(lambda: seen.merged and seen.plain and seen.truth, "readers with keys receive the voters' output and the truth", START_S)
    until_whole(secured, seen, "both voters stand on three lanes", START_S)
    until(lambda: not secured.not_healthy(), "every container is healthy", START_S)
    verdicts.check("every container is healthy, both voters stand on three lanes", True, f"after {time.monotonic() - begin_s:.1f} s")
    judge_fences(secured, verdicts)
    found = secured.wrong_keys()
    verdicts.check("every container holds its own private key alone, read-only", not found, found or "")


def judge_outsiders(seen, verdicts):
    for vendor, outsider in seen.outsiders.items():
        verdicts.check(f"a container without keys on {vendor} receives nothing", not outsider.samples, len(outsider.samples))
    refused = sorted({event.source for event in seen.events if UNCERTIFIED in event.text})
    verdicts.check("services on Fast DDS report it", refused, refused)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", type=pathlib.Path, help="folder for the logs of a failure")
    options = parser.parse_args()
    image = f"quorient:{os.environ['QUORIENT_TAG']}"
    secured, verdicts = Secured(os.environ["COMPOSE_PROJECT_NAME"], image, os.environ["QUORIENT_KEYS"]), Verdicts()
    with Seen(secured) as seen:
        try:
            start_up(secured, seen, verdicts)
            until_settled(seen)
            play_all(secured, seen, chapters(), verdicts)
            isolated = {sample.isolated for sample in seen.merged}
            verdicts.check("nothing is isolated, through every restart", isolated == {0}, sorted(isolated))
            judge_order(seen, verdicts)
            judge_outsiders(seen, verdicts)
            stop(secured, verdicts)
            found = private_keys_in_image(image)
            verdicts.check("the image holds no private key", not found, found or "")
        except (NotInTime, RuntimeError, subprocess.TimeoutExpired) as problem:
            verdicts.check("the scenario runs to its end", False, problem)
    return conclude(secured, verdicts, options.logs)


if __name__ == "__main__":
    sys.exit(main())
