"""Restarts as containers have them: a killed process comes back at once with the same process id, at the same address.

`python3 -m integration_tests.kill_matrix.same_identity [--restarts 20] [--vendor fastdds] [--transport shm] [--role voter] [--rate 100] [--seed N]`

Each process of the demo has a PID namespace of its own, in which it is process 1 in every life. Network and /dev/shm are shared, as by containers
of one host. A role is killed by SIGKILL and started again at once. What the killed process left in /dev/shm stays. Two times are measured from the kill:

- until its samples arrive again at two listeners that knew the killed process, one of either vendor, by UDP,
- until the system uses them again, by the transport that is tested: both voters follow the new epoch (sensor) or count the lane (detector,
  integrator). For a voter a plain reader of `voted`, of either vendor, receives its samples again.

Neither may take longer than two leases. The lease is that of discovery: so long the peers take a silent process for alive. The lease of `voted` (50 ms)
decides who owns the output. It ends before a new process has even started.

iceoryx does not work between namespaces of process ids. Our processes refuse its daemon there, and go on by UDP with an alarm.
"""
import argparse
import itertools
import math
import os
import pathlib
import random
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

from integration_tests.harness.pipeline import ALL_LANES, BIN, CONFIGURATIONS, NotInTime, Pipeline, ask_for_priority, at_least_once, rate_between
from integration_tests.harness.streams import Recording, parse_voted

LEASE_S = 10.0  # of a participant: common/bus/fastdds/src/participant.cpp; Cyclone DDS's default is the same
BOUND_S = 2 * LEASE_S
VENDORS = ("fastdds", "cyclonedds")
SHARED_MEMORY = {"fastdds": "shm", "cyclonedds": "iceoryx"}
OWN_PROCESS_IDS = ("unshare", "--pid", "--fork", "--mount-proc", "--kill-child")
MEMORY = pathlib.Path("/dev/shm")
# What a killed process has sent may still be on its way to a listener. A frame so much newer than all that it has received cannot be of that.
BEYOND_FRAMES = 10
FLOWING = 20  # samples
SKIPPED = 77
LANES = "lanes=[{name: a, detector: {method: vector}}, {name: b, detector: {method: vector}}, {name: c, detector: {method: extrapolation}}]"
MEMORY_POOLS = ((2048, 16384), (8192, 2048), (16384, 512))  # size and number of iceoryx's chunks, for all nine processes
STEADY_S = (0.1, 0.9)  # between two restarts: participants announce themselves once a second


class Role(NamedTuple):
    process: str
    topic: str
    sender: str  # the field that says whose a sample is: 1 for the process that is killed


ROLES = {
    "sensor": Role("sensor", "frame", "unit"),
    "detector": Role("fdi-a", "verdict", "detector"),
    "integrator": Role("attitude-a", "attitude", "lane"),
    "voter": Role("voter-1", "voter_output", "voter"),
}
PROCESSES = ("sensor", *(f"{role}-{lane}" for role in ("fdi", "attitude") for lane in "abc"), "voter-1", "voter-2")


class Heard(NamedTuple):
    identity: tuple
    own: bool  # of the process that is killed
    arrival_s: float


class Known(NamedTuple):
    """What a listener had received when a process was killed."""

    count: int
    newest: tuple


class Restart(NamedTuple):
    flows_s: float  # infinite where it took longer than the bound
    used_s: float

    @property
    def holds(self):
        return max(self) <= BOUND_S


class ContainedPipeline(Pipeline):
    """Stands for a Pipeline: the same waits, without `quorient launch`. Each process has a PID namespace of its own."""

    def __init__(self, role, vendor, transport, rate_hz):
        self.role, self.rate_hz, self._transport = role, rate_hz, transport
        self.run_directory = pathlib.Path(tempfile.mkdtemp(prefix="quorient-identity-"))
        self.environment = dict(os.environ, QUORIENT_RUN_DIR=str(self.run_directory))
        self.domain = 120 + int.from_bytes(os.urandom(2), "big") % 100
        self.timeout_s = 30
        self.keys = None
        assignments = ("expect=null", f"source.rate_hz={rate_hz}", "source.duration_s=3600", "source.faults=[]", f"dds={vendor}",
                       f"transport={transport}", "shared_memory=preferred", "voters=[{name: voter-1}, {name: voter-2}]", LANES)
        self._settings = [word for assignment in assignments for word in ("--set", assignment)]
        self.processes, self.recordings = {}, []
        try:
            self._start_all()
        except BaseException:
            self.__exit__()
            raise

    def _start_all(self):
        if self._transport == "iceoryx":
            self._start_roudi()
        self.of_role = self._listen(self.role.topic, self._parse)
        self.outputs = self._listen("voter_output", parse_voted)
        self.voted = self._listen("voted", parse_voted)
        for name in PROCESSES:
            self._start(name)
        self.launch = self.processes["voter-2"]  # never killed: the run is over when it ends

    def __exit__(self, *_):
        for process in self.processes.values():
            process.kill()  # and with it, by --kill-child, what runs inside
            process.wait()
        for recording in self.recordings:
            recording.stop()
        self.run("clean")
        shutil.rmtree(self.run_directory, ignore_errors=True)

    @staticmethod
    def _roudi_answers():
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as probe:
            return probe.connect_ex("/tmp/roudi") == 0

    def _start_roudi(self):
        if self._roudi_answers():
            raise NotInTime("an iox-roudi that is not this program's runs on this machine")
        configuration = self.run_directory / "roudi.toml"
        pools = "".join(f"[[segment.mempool]]\nsize = {size}\ncount = {count}\n" for size, count in MEMORY_POOLS)
        configuration.write_text(f"[general]\nversion = 1\n[[segment]]\n{pools}")
        # Not beside this program: RouDi signals its clients by the ids that they have in their own namespaces.
        self._popen("roudi", [*OWN_PROCESS_IDS, shutil.which("iox-roudi"), "-c", str(configuration)])
        deadline = time.monotonic() + self.timeout_s
        while not self._roudi_answers():
            if time.monotonic() > deadline:
                raise NotInTime(f"iceoryx's daemon does not answer: {self.log_of('roudi')}")
            time.sleep(0.01)

    def _listen(self, topic, parse):
        """One listener of either vendor."""
        lease_s = max(0.05, 3 / self.rate_hz)
        started = [Recording(self.command("echo", topic, "--json", "--domain", self.domain, "--dds", vendor, "--lease", lease_s), self.environment, parse)
                   for vendor in VENDORS]
        self.recordings += started
        return started

    def _parse(self, sample, arrival_s):
        return Heard((sample["epoch"], sample["sequence_number"]), sample[self.role.sender] == 1, arrival_s)

    def _popen(self, name, command):
        with open(self.run_directory / f"{name}.log", "a") as log:
            self.processes[name] = subprocess.Popen(command, env=self.environment, stdout=log, stderr=subprocess.STDOUT)

    def _start(self, name):
        program = str(BIN / f"quorient-{name.partition('-')[0]}")
        self._popen(name, [*OWN_PROCESS_IDS, program, str(CONFIGURATIONS / "demo.yaml"), "--name", name, "--domain", str(self.domain), *self._settings])

    def _inside(self, name):
        """Id of the process in the namespace as this program sees it, and as itself does."""
        outer = self.processes[name].pid
        child = pathlib.Path(f"/proc/{outer}/task/{outer}/children").read_text().split()[0]
        status = pathlib.Path(f"/proc/{child}/status").read_text()
        return int(child), int(status.partition("NSpid:")[2].splitlines()[0].split()[-1])

    def until_running(self):
        """Until all processes receive, and the voters count all lanes."""
        self.until(lambda: all(recording.newest for recording in self.recordings), "all listeners receive samples")
        self.until(lambda: all(recording.newest.vouching == ALL_LANES for recording in self.outputs), "all lanes count")

    @staticmethod
    def memory_used():
        """Of /dev/shm, in KiB."""
        blocks = os.statvfs(MEMORY)
        return (blocks.f_blocks - blocks.f_bfree) * blocks.f_frsize / 1024

    def uses_shared_memory(self):
        return self._transport != "udp" and not any("was asked for" in self.log_of(name) for name in PROCESSES)

    def restart(self):
        """Kills the role's process and starts it again. @returns both times."""
        process, own_id = self._inside(self.role.process)
        os.kill(process, signal.SIGKILL)
        killed_s = time.monotonic()
        self.processes[self.role.process].wait()
        known = {id(recording): Known(len(recording.samples), recording.newest.identity) for recording in self.recordings}
        self._start(self.role.process)
        flowing = self._first_of_each(killed_s, self.of_role, lambda recording: self._flowing(recording, known[id(recording)]))
        if flowing is None:
            return Restart(math.inf, math.inf)
        if self._inside(self.role.process)[1] != own_id:
            raise AssertionError("the new process has another process id in its namespace")
        since = min(sample.identity for sample in flowing)
        users = self.voted if self.role.topic == "voter_output" else self.outputs
        used = self._first_of_each(killed_s, users, lambda recording: self._used(recording, known[id(recording)].count, since))
        latest_s = [max(sample.arrival_s for sample in samples) - killed_s if samples else math.inf for samples in (flowing, used)]
        return Restart(*latest_s)

    def _first_of_each(self, killed_s, recordings, first):
        """What `first` finds in each recording; None where that is not within the bound."""
        try:
            self.until(lambda: all(first(recording) for recording in recordings), "", BOUND_S - (time.monotonic() - killed_s))
        except NotInTime:
            return None
        return [first(recording) for recording in recordings]

    def _flowing(self, recording, known):
        """The first sample of the new process, once there are some."""
        new = (sample for sample in recording.samples[known.count:] if sample.own and self._beyond(sample.identity, known.newest))
        samples = list(itertools.islice(new, FLOWING))
        return samples[0] if len(samples) == FLOWING else None

    def _beyond(self, identity, newest):
        if self.role.topic == "frame":
            return identity[0] > newest[0]
        return identity >= (newest[0], newest[1] + BEYOND_FRAMES)

    def _used(self, recording, count, since):
        """The sample with which the last user uses what has come since."""
        first = {}
        for sample in recording.samples[count:]:
            if sample.identity >= since and self._shows_use(sample):
                first.setdefault(sample.voter, sample)
        needed = {1} if self.role.topic == "voter_output" else {1, 2}
        return max(first.values(), key=lambda sample: sample.arrival_s) if needed <= first.keys() else None

    def _shows_use(self, sample):
        return self.role.topic in ("frame", "voter_output") or sample.vouching & 1


def play(role, vendor, transport, restarts, rate_hz, chance):
    """@returns the restarts, by how many KiB of /dev/shm each has raised what is in use, and whether shared memory was in use to the end."""
    done = []
    with ContainedPipeline(ROLES[role], vendor, SHARED_MEMORY[vendor] if transport == "shm" else "udp", rate_hz) as pipeline:
        pipeline.until_running()
        at_start = pipeline.memory_used()
        for _ in range(restarts):
            time.sleep(chance.uniform(*STEADY_S))
            done.append(pipeline.restart())
            if not done[-1].holds:
                print(f"--- {role}, {vendor}, {transport}, restart {len(done)}: {done[-1]}\n{pipeline.log_of(pipeline.role.process)}", file=sys.stderr)
        return done, (pipeline.memory_used() - at_start) / restarts, pipeline.uses_shared_memory()


def seconds(values):
    return f"{statistics.median(values):.2f} | {max(values):.2f}"


def row(role, vendor, transport, restarts, left, shared):
    if transport == "shm" and not shared:
        transport = "shm, refused: udp"
    within = sum(restart.holds for restart in restarts)
    flows_s, used_s = zip(*restarts)
    return f"| {role} | {vendor} | {transport} | {within} of {len(restarts)} | {seconds(flows_s)} | {seconds(used_s)} | {left:.0f} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--restarts", type=at_least_once, default=20)
    parser.add_argument("--vendor", choices=VENDORS, action="append", help="default: both")
    parser.add_argument("--transport", choices=("udp", "shm"), action="append", help="default: both; shm of Cyclone DDS is iceoryx")
    parser.add_argument("--role", choices=ROLES, action="append", help="default: all")
    parser.add_argument("--rate", type=rate_between(50, 200), default=100, help="frames per second")
    parser.add_argument("--seed", type=int, default=random.randrange(1 << 30))
    options = parser.parse_args()
    if os.geteuid() != 0 or not shutil.which("unshare"):
        print("namespaces of process ids need root and unshare", file=sys.stderr)
        return SKIPPED
    ask_for_priority()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # no process of a pipeline is left
    chance = random.Random(options.seed)
    failed = 0
    print("| role | vendor | transport | within two leases | received again, median [s] | worst [s] | used again, median [s] | worst [s] | left in /dev/shm by each [KiB] |\n"
          "|" + "---|" * 9, flush=True)
    for vendor, transport, role in itertools.product(options.vendor or VENDORS, options.transport or ("udp", "shm"), options.role or ROLES):
        if transport == "shm" and vendor == "cyclonedds" and not shutil.which("iox-roudi"):
            print("iceoryx is not installed", file=sys.stderr)
            continue
        restarts, left, shared = play(role, vendor, transport, options.restarts, options.rate, chance)
        failed += sum(not restart.holds for restart in restarts)
        print(row(role, vendor, transport, restarts, left, shared), flush=True)
    print(f"\n{failed} restarts took longer than {BOUND_S:.0f} s; made by `python3 -m integration_tests.kill_matrix.same_identity "
          f"{' '.join(sys.argv[1:])}` (seed {options.seed})")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
