"""The attacks on a running system, each from both vendors at once, and what reached whom."""
import json
import shutil
import subprocess
import threading
import time
from dataclasses import dataclass

from integration_tests.harness.processes import BIN, CONFIGURATIONS

VENDORS = ("fastdds", "cyclonedds")
MARK = {"fastdds": 99, "cyclonedds": 98}  # in each forged sample: the vendor that wrote it (rogue.cpp)
VOTER_VENDOR = {"1": "cyclonedds", "2": "fastdds"}  # of the demo's voters
ATTACK_S = 3.0  # a member receives its first samples after 0.2 to 1.2 s
EVERYTHING = "cluster,frame,truth,verdict,diagnosis,attitude,voter_output,voted,event,status,command"


@dataclass
class Case:
    name: str
    arguments: tuple  # of quorient-rogue; {keys} is the folder that contains all sets of keys
    publish: str = EVERYTHING
    twin: bool = False  # permitted to publish: its samples arrive
    reads: bool = False  # permitted to subscribe: it receives samples


CASES = (
    Case("no certificate", ()),
    Case("a certificate of another authority", ("--keys", "{keys}/others", "--as", "voter-1")),
    Case("an expired certificate, its clock set back", ("--keys", "{keys}/keys", "--as", "expired", "--clock", "-86400")),
    Case("a revoked certificate, with the old list", ("--keys", "{keys}/before", "--as", "gone")),
    Case("a detector publishes frames", ("--keys", "{keys}/keys", "--as", "fdi-c"), "frame", reads=True),
    Case("the same, its DDS patched to permit it", ("--keys", "{keys}/keys", "--as", "fdi-c", "--patched"), "frame", reads=True),
    Case("a voter publishes frames and attitudes, patched", ("--keys", "{keys}/keys", "--as", "voter-1", "--patched"), "frame,attitude", reads=True),
    Case("a monitor sends orders", ("--keys", "{keys}/keys", "--as", "monitor"), "command", reads=True),
    Case("the same, patched", ("--keys", "{keys}/keys", "--as", "monitor", "--patched"), "command", reads=True),
    Case("a detector with forged permissions of a sensor", ("--keys", "{keys}/forged", "--as", "second-detector"), "frame"),
    Case("twin: a second sensor of the system", ("--keys", "{keys}/keys", "--as", "second-sensor"), "frame", twin=True, reads=True),
    Case("twin: an operator sends orders", ("--keys", "{keys}/keys", "--as", "operator"), "command", twin=True, reads=True),
)
WITHOUT_SECURITY = (Case("no certificate, in a system without security", (), "frame,command", twin=True, reads=True),)


def quorient(*words):
    return subprocess.run([str(BIN / "quorient"), *map(str, words)], check=True, capture_output=True, text=True, timeout=30).stdout


def prepare(keys):
    """Makes, beside the system's own keys, those of another authority, expired, revoked and forged ones."""
    folder = keys.parent
    domain = json.loads((keys / "authority/identities.json").read_text())["domain"]
    quorient("keys", CONFIGURATIONS / "demo.yaml", "--out", folder / "others", "--domain", domain)
    quorient("keys", "--out", keys, "--add", "expired", "--role", "sensor", "--days", "0.00001")
    quorient("keys", "--out", keys, "--add", "second-sensor", "--role", "sensor")
    quorient("keys", "--out", keys, "--add", "gone", "--role", "sensor")
    shutil.copytree(keys, folder / "before")
    quorient("keys", "--out", keys, "--revoke", "gone")
    forge(keys, folder / "others", folder / "forged")


def forge(keys, others, forged):
    """A detector with its own certificate, and permissions of a sensor signed by another authority of the same name."""
    name = "second-detector"
    quorient("keys", "--out", keys, "--add", name, "--role", "detector")
    quorient("keys", "--out", others, "--add", name, "--role", "sensor")
    shutil.copytree(keys, forged)
    for file in ("shared/permissions_ca.pem", "shared/governance.p7s", f"{name}/permissions.p7s"):
        shutil.copy(others / file, forged / file)


def start_rogue(vendor, domain, *words, environment):
    return subprocess.Popen([str(BIN / "quorient-rogue"), "--dds", vendor, "--domain", str(domain), *map(str, words)], env=environment,
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)


class Listener:
    """A monitor on one vendor that counts the forged samples which reach it."""

    def __init__(self, vendor, domain, keys, environment):
        self.counts = None
        self.reports = 0
        self._process = start_rogue(vendor, domain, "--report", "--seconds", 1000, *(("--keys", keys, "--as", "monitor") if keys else ()),
                                    environment=environment)
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self._process.stdout:
            self.counts = json.loads(line)
            self.reports += 1

    def forged(self, vendor):
        """Forged samples of this vendor so far."""
        return self.counts["forged"].get(str(MARK[vendor]), 0) if self.counts else 0

    def receives(self):
        return bool(self.counts) and all(self.counts["of_voter"].get(voter) for voter in VOTER_VENDOR)

    def stop(self):
        self._process.kill()
        self._process.wait(5)


@dataclass
class Outcome:
    """The result of one case on one vendor."""

    case: Case
    vendor: str
    joined: bool
    refused_locally: bool
    read: dict  # samples that the rogue received from the voter on each vendor
    arrived: dict  # forged samples that reached the listener on each vendor
    events: list  # that the system published meanwhile

    def broken(self):
        """What differs from what security promises."""
        for victim in VENDORS:
            if bool(self.arrived[victim]) != self.case.twin:
                yield f"{self.arrived[victim]} forged samples reached {victim}"
            if bool(self.read[victim]) != self.case.reads:
                yield f"{self.read[victim]} samples of {victim} were read"


def run_case(case, pipeline, listeners, events):
    """Runs the rogues of both vendors at once. @returns an outcome for each."""
    before = {vendor: {victim: listeners[victim].forged(vendor) for victim in VENDORS} for vendor in VENDORS}
    first_event = len(events)
    words = [word.format(keys=pipeline.run_directory) for word in case.arguments]
    rogues = {vendor: start_rogue(vendor, pipeline.domain, *words, "--publish", case.publish, "--seconds", ATTACK_S, environment=pipeline.environment)
              for vendor in VENDORS}
    results = {vendor: json.loads(rogue.communicate(timeout=60)[0]) for vendor, rogue in rogues.items()}
    time.sleep(0.5)  # two reports of the listeners and one status of each service: all samples of the attack are counted
    outcomes = []
    for vendor, result in results.items():
        given = result.get("of_voter", {})
        outcomes.append(Outcome(
            case, vendor, result["joined"], bool(result.get("refused_locally")) or not result["joined"],
            {VOTER_VENDOR[voter]: given.get(voter, 0) for voter in VOTER_VENDOR},
            {victim: listeners[victim].forged(vendor) - before[vendor][victim] for victim in VENDORS}, events[first_event:]))
    return outcomes
