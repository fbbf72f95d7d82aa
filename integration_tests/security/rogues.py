"""The attacks on a running system, from either vendor, and what reached whom."""
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
SERVICE_VENDOR = {"sensor": "cyclonedds", "fdi-a": "cyclonedds", "attitude-a": "cyclonedds", "fdi-b": "fastdds", "attitude-b": "fastdds",
                  "fdi-c": "cyclonedds", "attitude-c": "cyclonedds", "voter-1": "cyclonedds", "voter-2": "fastdds"}
SECURITY = 57  # event code
ATTACK_S = 4.0  # a member receives its first samples after 0.2 to 1.2 s
PATIENCE_S = 15.0  # for a member on a busy machine
SETTLING_S = 0.5  # two reports of the listeners and one status of each service: all samples of the attack are counted
EVERYTHING = "cluster,frame,truth,verdict,diagnosis,attitude,voter_output,voted,event,status,command"


@dataclass
class Case:
    name: str
    arguments: tuple  # of quorient-rogue; {keys} is the folder that contains all sets of keys, {vendor} the rogue's vendor
    publish: str = EVERYTHING
    twin: bool = False  # permitted to publish: its samples arrive
    reads: bool | None = False  # subscribes what voters publish: refused, or permitted (None), or permitted and expected to arrive
    reported_by: tuple = ()  # the vendors that let the services on them know


CASES = (
    Case("no certificate", ("--as", "nobody-{vendor}"), reported_by=("fastdds",)),
    Case("a certificate of another authority", ("--keys", "{keys}/others", "--as", "operator-{vendor}"), reported_by=("fastdds",)),
    Case("an expired certificate, its clock set back", ("--keys", "{keys}/keys", "--as", "expired-{vendor}", "--clock", "-86400"), reported_by=VENDORS),
    Case("a revoked certificate, with the old list", ("--keys", "{keys}/before", "--as", "gone-{vendor}"), reported_by=VENDORS),
    Case("a detector publishes frames", ("--keys", "{keys}/keys", "--as", "fdi-c"), "frame", reads=None),
    Case("the same, its DDS patched to permit it", ("--keys", "{keys}/keys", "--as", "fdi-c", "--patched"), "frame", reads=None, reported_by=("fastdds",)),
    Case("a voter publishes frames and attitudes, patched", ("--keys", "{keys}/keys", "--as", "voter-1", "--patched"), "frame,attitude", reads=None,
         reported_by=("fastdds",)),
    Case("a monitor sends orders", ("--keys", "{keys}/keys", "--as", "monitor"), "command", reads=None),
    Case("the same, patched", ("--keys", "{keys}/keys", "--as", "monitor", "--patched"), "command", reads=None, reported_by=("fastdds",)),
    Case("a detector with forged permissions of an operator", ("--keys", "{keys}/forged", "--as", "second-detector"), "command", reported_by=VENDORS),
    Case("twin: a second sensor of the system", ("--keys", "{keys}/keys", "--as", "second-sensor"), "frame", twin=True),
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
    quorient("keys", "--out", keys, "--add", "second-sensor", "--role", "sensor")
    # A name for each vendor: a service reports each refused name once.
    for vendor in VENDORS:
        quorient("keys", "--out", folder / "others", "--add", f"operator-{vendor}", "--role", "operator")
        quorient("keys", "--out", keys, "--add", f"expired-{vendor}", "--role", "operator", "--days", "0.00001")
        quorient("keys", "--out", keys, "--add", f"gone-{vendor}", "--role", "operator")
    shutil.copytree(keys, folder / "before")
    for vendor in VENDORS:
        quorient("keys", "--out", keys, "--revoke", f"gone-{vendor}")
    forge(keys, folder / "others", folder / "forged")


def forge(keys, others, forged):
    """A detector with its own certificate, and permissions of an operator signed by another authority of the same name."""
    name = "second-detector"
    quorient("keys", "--out", keys, "--add", name, "--role", "detector")
    quorient("keys", "--out", others, "--add", name, "--role", "operator")
    shutil.copytree(keys, forged)
    for file in ("shared/permissions_ca.pem", "shared/governance.p7s", f"{name}/permissions.p7s"):
        shutil.copy(others / file, forged / file)


class Rogue:
    """A running quorient-rogue, and its newest counts."""

    def __init__(self, vendor, pipeline, *words):
        self.counts = None
        self.reports = 0
        self.log = pipeline.run_directory / f"rogue_{vendor}.log"
        with open(self.log, "a") as log:
            self._process = subprocess.Popen(
                [str(BIN / "quorient-rogue"), "--report", "--dds", vendor, "--domain", str(pipeline.domain), *map(str, words)],
                env=pipeline.environment, stdout=subprocess.PIPE, stderr=log, text=True)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._process.stdout:
            self.counts = json.loads(line)
            self.reports += 1

    def joined(self):
        return bool(self.counts) and self.counts["joined"]

    def read_from(self, vendor):
        """Samples that the voter on this vendor published."""
        return sum(self.counts.get("of_voter", {}).get(voter, 0) for voter, its in VOTER_VENDOR.items() if its == vendor) if self.counts else 0

    def refused_locally(self):
        return not self.joined() or bool(self.counts["refused_locally"])

    def ends(self):
        """@throws RuntimeError with the end of its log if it has died."""
        if self._process.poll() not in (None, 0):
            raise RuntimeError(f"{self._process.args} ended with {self._process.returncode}: {self.log.read_text()[-1500:]}")

    def stop(self):
        self._process.kill()
        self._process.wait(5)
        self._reader.join(5)
        self._process.stdout.close()


class Listener(Rogue):
    """A monitor on one vendor that counts the forged samples which reach it."""

    def __init__(self, vendor, pipeline):
        super().__init__(vendor, pipeline, "--seconds", 1000, *(("--keys", pipeline.keys, "--as", "monitor") if pipeline.keys else ()))

    def forged(self, vendor):
        """Forged samples of this vendor so far."""
        return self.counts["forged"].get(str(MARK[vendor]), 0) if self.counts else 0

    def receives(self):
        return all(self.read_from(vendor) for vendor in VENDORS)


@dataclass
class Outcome:
    """The result of one case on one vendor."""

    case: Case
    vendor: str
    refused_locally: bool
    read: dict  # samples that the rogue received from the voter on each vendor
    arrived: dict  # forged samples that reached the listener on each vendor
    events: list  # that the system published meanwhile

    def refusals(self, vendor):
        """Texts of the events by which the services on this vendor report a refusal."""
        return sorted({event["text"] for event in self.events if event["code"] == SECURITY and SERVICE_VENDOR[event["source_name"]] == vendor})

    def broken(self):
        """What differs from what security promises."""
        for victim in VENDORS:
            if bool(self.arrived[victim]) != self.case.twin:
                yield f"{self.arrived[victim]} forged samples reached {victim}"
            if self.case.reads is not None and bool(self.read[victim]) != self.case.reads:
                yield f"{self.read[victim]} samples of {victim} were read"
        for victim in self.case.reported_by:
            if not self.refusals(victim):
                yield f"no service on {victim} reported it"


def run_case(case, vendor, pipeline, listeners, events):
    """Runs one rogue beside the system: for ATTACK_S, and longer while what is expected of it has not been seen."""
    before = {victim: listeners[victim].forged(vendor) for victim in VENDORS}
    first_event = len(events)
    words = [word.format(keys=pipeline.run_directory, vendor=vendor) for word in case.arguments]
    rogue = Rogue(vendor, pipeline, *words, "--publish", case.publish, "--seconds", 1000)
    arrived = lambda victim: listeners[victim].forged(vendor) - before[victim]  # noqa: E731
    so_far = lambda: Outcome(case, vendor, rogue.refused_locally(), {victim: rogue.read_from(victim) for victim in VENDORS},  # noqa: E731
                             {victim: arrived(victim) for victim in VENDORS}, events[first_event:])
    ends_s = time.monotonic() + ATTACK_S
    try:
        while time.monotonic() < ends_s or any(so_far().broken()) and time.monotonic() < ends_s + PATIENCE_S:
            rogue.ends()
            time.sleep(0.05)
    finally:
        rogue.stop()
    time.sleep(SETTLING_S)
    return so_far()
