"""The default demo spread over hosts, and listeners on one of them."""
import os
import pathlib
import shutil
import subprocess
import tempfile
from typing import NamedTuple

from integration_tests.harness.pipeline import BIN, CONFIGURATIONS, END_OF_GRACE_FRAMES, Pipeline
from integration_tests.harness.streams import Recording, parse_truth, parse_voted

DOMAIN = 60  # namespaces keep runs apart


class Place(NamedTuple):
    """Where a process runs and how it joins: the vendor and the interface, `any` for all of the host's."""

    host: str
    vendor: str
    interface: str = "eth0"


class Verdict(NamedTuple):
    lane: int
    isolated: int


def parse_verdict(sample, _):
    return Verdict(sample["detector"], sample["isolated_mask"])


class SpreadPipeline(Pipeline):
    """Stands for a Pipeline: the same waits and recordings, without `quorient launch`, which would start all on one host."""

    def __init__(self, hosts, places, listener, rate_hz, *assignments, start_timeout_s=40):
        """@param places {process name: Place}, listener Place of the recordings."""
        self.rate_hz = rate_hz
        self._lease_s = max(0.05, 3 / rate_hz)  # a reader of `voted` that asks for less than the voters offer is refused
        assignments = (f"source.rate_hz={rate_hz}", *assignments)
        self.run_directory = pathlib.Path(tempfile.mkdtemp(prefix="quorient-networks-"))
        self.environment = dict(os.environ, QUORIENT_RUN_DIR=str(self.run_directory))
        self.domain = DOMAIN
        self.timeout_s = start_timeout_s
        self._hosts = hosts
        self.processes = {}
        self.recordings = []
        try:
            self.merged = self._listen(listener, "voter_output", parse_voted)
            self.plain = self._listen(listener, "voted", parse_voted)
            self.truth = self._listen(listener, "truth", parse_truth)
            self.verdicts = self._listen(listener, "verdict", parse_verdict)
            for name, place in places.items():
                self.processes[name] = self._start(name, place, assignments)
        except BaseException:
            self.__exit__()
            raise
        self.launch = self.processes["sensor"]  # the run is over when it ends

    def __exit__(self, *_):
        for process in self.processes.values():
            if process.poll() is None:
                process.kill()
            process.wait()
        for recording in self.recordings:
            recording.stop()
        shutil.rmtree(self.run_directory, ignore_errors=True)

    def _peers(self, place):
        networks = self._hosts.networks_of_host[place.host]
        return self._hosts.addresses(networks if place.interface == "any" else networks[:1])

    def _listen(self, place, topic, parse):
        peers = [word for address in self._peers(place) for word in ("--peer", address)]
        command = [*self._hosts.inside(place.host), *self.command("echo", topic, "--json", "--domain", self.domain, "--dds", place.vendor),
                   "--interface", place.interface, "--lease", str(self._lease_s), *peers]
        self.recordings.append(Recording(command, self.environment, parse))
        return self.recordings[-1]

    def _start(self, name, place, assignments):
        program = BIN / f"quorient-{name.partition('-')[0]}"
        settings = ["expect=null", f"interface={place.interface}", f"peers=[{', '.join(self._peers(place))}]", *assignments]
        command = [*self._hosts.inside(place.host), str(program), str(CONFIGURATIONS / "demo.yaml"), "--name", name, "--dds", place.vendor,
                   "--domain", str(self.domain), *(word for assignment in settings for word in ("--set", assignment))]
        with open(self.run_directory / f"{name}.log", "w") as log:
            return subprocess.Popen(command, env=self.environment, stdout=log, stderr=subprocess.STDOUT)

    def ended_early(self):
        """Processes that have ended, with their exit codes."""
        return {name: process.poll() for name, process in self.processes.items() if process.poll() is not None}

    def finish(self):
        """Ends the run in order. @returns the same figures as a launch's summary, computed from what the listeners received."""
        epoch, sequence = self.truth.newest.identity
        self.end = (epoch, sequence - END_OF_GRACE_FRAMES)
        self.gone = self.ended_early()
        for process in self.processes.values():
            process.terminate()
        for process in self.processes.values():
            process.wait(timeout=15)
        for recording in self.recordings:
            recording.stop()
        lanes = {}
        for verdict in self.verdicts.samples:
            lanes[verdict.lane] = lanes.get(verdict.lane, 0) | verdict.isolated
        answered = {sample.identity for sample in self.merged.samples}
        missing = sum(self.merged.samples[0].identity <= truth.identity <= self.end and truth.identity not in answered
                      for truth in self.truth.samples)
        return {"voted": {"missing": missing},
                "lanes": {lane: {"isolated": [axis for axis in range(64) if mask >> axis & 1], "frames_to_isolation": None}
                          for lane, mask in lanes.items()}}
