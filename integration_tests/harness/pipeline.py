"""One system under test: `quorient launch`, its children, and three independent listeners."""
import argparse
import itertools
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from integration_tests.harness import exact_json
from integration_tests.harness.processes import BIN, CONFIGURATIONS, children_of, words_of
from integration_tests.harness.streams import Recording, parse_truth, parse_voted

RATE_HZ = 200
LEVELS = ("none", "sign", "encrypt")  # of DDS Security
ALL_LANES = 0b111
END_OF_GRACE_FRAMES = 20  # frames in flight while everything stops do not count as lost


class NotInTime(Exception):
    pass


def at_least_once(text):
    """For argparse."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}': a whole number from 1 on is needed")
    return int(text)


def rate_between(least_hz, most_hz=1000):
    """For argparse: whole frames per second within what a system under test can be judged at."""
    def parse(text):
        if not text.isdecimal() or not least_hz <= int(text) <= most_hz:
            raise argparse.ArgumentTypeError(f"'{text}': a whole number from {least_hz} to {most_hz} Hz is needed")
        return int(text)

    return parse


def ask_for_priority():
    """A loaded machine must not be mistaken for a dead process: everything under test runs before other people's work, where permitted."""
    try:
        os.setpriority(os.PRIO_PROCESS, 0, -15)
    except PermissionError:
        print("no permission to raise the priority: on a loaded machine times are not those of the system", file=sys.stderr)


class Pipeline:
    """Use as a context: whatever happens inside, every process that it started is ended by its id. With a level it makes keys and runs secured."""

    def __init__(self, *assignments, plain_vendor="cyclonedds", launch_timeout_s=30, rate_hz=RATE_HZ, level="none", prepare=lambda keys: None,
                 without=()):
        self.rate_hz = rate_hz
        self.run_directory = pathlib.Path(tempfile.mkdtemp(prefix="quorient-kill-"))
        self.environment = dict(os.environ, QUORIENT_RUN_DIR=str(self.run_directory))
        self.domain = 120 + int.from_bytes(os.urandom(2), "big") % 100
        self.timeout_s = launch_timeout_s
        self.started_again = []
        self.stopped = []
        self.keys = self._make_keys(level) if level != "none" else None
        if self.keys:
            prepare(self.keys)
            assignments += (f"security.directory={self.keys}", f"security.level={level}")
        self.settings = [word for assignment in ("expect=null", f"source.rate_hz={rate_hz}", *assignments) for word in ("--set", assignment)]
        absent = [word for name in without for word in ("--without", name)]
        self.launched_s = time.monotonic()
        self.launch = subprocess.Popen(
            self.command("launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--json", *absent, *self.settings),
            env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        self.merged = self._record("voter_output", "cyclonedds", parse_voted)
        self.plain = self._record("voted", plain_vendor, parse_voted)
        self.truth = self._record("truth", "cyclonedds", parse_truth)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.stopped:
            self._signal(process, signal.SIGCONT)
        for process in (self.launch, *self.started_again):
            if process.poll() is None:
                process.kill()
            process.communicate()
        for recording in (self.merged, self.plain, self.truth):
            recording.stop()
        shutil.rmtree(self.run_directory, ignore_errors=True)

    def command(self, verb, *arguments):
        return [str(BIN / "quorient"), verb, *map(str, arguments)]

    def _make_keys(self, level):
        keys = self.run_directory / "keys"
        subprocess.run(self.command("keys", CONFIGURATIONS / "demo.yaml", "--out", keys, "--domain", self.domain, "--set", f"security.level={level}",
                                    "--set", f"security.directory={keys}"), check=True, stdout=subprocess.DEVNULL, timeout=30)
        return keys

    def with_keys(self):
        """The options of a verb that joins."""
        return ("--keys", self.keys) if self.keys else ()

    def run(self, verb, *arguments):
        """Another verb of the command line beside the running system."""
        return subprocess.run(
            self.command(verb, *arguments, "--domain", self.domain, *self.with_keys()), env=self.environment, capture_output=True, text=True, timeout=30
        )

    def _record(self, topic, vendor, parse):
        return Recording(self.command("echo", topic, "--json", "--domain", self.domain, "--dds", vendor, *self.with_keys()), self.environment, parse)

    def until(self, condition, what, timeout_s=None):
        deadline = time.monotonic() + (timeout_s or self.timeout_s)
        while not condition():
            if time.monotonic() > deadline:
                raise NotInTime(f"not within {timeout_s or self.timeout_s} s: {what}")
            if self.launch.poll() is not None:
                raise NotInTime(f"the run ended before: {what}")
            time.sleep(0.01)

    def until_running(self):
        recorded = (self.merged, self.plain, self.truth)
        self.until(lambda: all(recording.newest for recording in recorded), "all three listeners receive samples")

    def until_frame(self, frame):
        """Returns when the publisher's frame is due, as estimated from the truth sample with the shortest delay so far. @returns that frame."""
        self.until(lambda: self.truth.newest and self.truth.newest.identity[1] >= frame - self.rate_hz / 4, f"frame {frame} is near")
        epoch = self.truth.newest.identity[0]
        recorded = [truth for truth in self.truth.samples[-self.rate_hz:] if truth.identity[0] == epoch]
        start_s = min(truth.arrival_s - truth.identity[1] / self.rate_hz for truth in recorded)
        time.sleep(max(0.0, start_s + frame / self.rate_hz - time.monotonic()))
        return (epoch, int(frame))

    def process_of(self, name):
        """Process id of the newest child with this name; only children of this run's launch, and what this run started again."""
        for again in reversed(self.started_again):
            if again.poll() is None and again.args[again.args.index("--name") + 1] == name:
                return again.pid
        for child in children_of(self.launch.pid):
            if name in (self._name_of(child), *self._members_of(child)):
                return child
        return None

    def names(self):
        return [name for name in map(self._name_of, children_of(self.launch.pid)) if name]

    @classmethod
    def _members_of(cls, process):
        """Names of the system file's processes that run in this one."""
        words = words_of(process)
        if words and words[0].endswith("/quorient-run"):
            return list(itertools.takewhile(lambda word: not word.startswith("--"), words[2:]))
        return [words[words.index("--name") + 1]] if "--name" in words and "quorient-" in words[0] else []

    @classmethod
    def _name_of(cls, process):
        return "+".join(cls._members_of(process)) or None

    @staticmethod
    def _signal(process, number):
        try:
            os.kill(process, number)
        except ProcessLookupError:
            pass

    @staticmethod
    def is_gone(process):
        """Ended: no such process, or one that only waits to be collected."""
        try:
            return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
        except (FileNotFoundError, ProcessLookupError):
            return True

    def kill(self, name):
        self._signal(self.process_of(name), signal.SIGKILL)

    def stop_for(self, names, duration_s):
        """SIGSTOP, the time that the fault lasts, SIGCONT."""
        self.stopped = [self.process_of(name) for name in names]
        for process in self.stopped:
            self._signal(process, signal.SIGSTOP)
        time.sleep(duration_s)
        for process in self.stopped:
            self._signal(process, signal.SIGCONT)
        self.stopped = []

    def terminate(self, name):
        """SIGTERM, and waits for the goodbye. @returns how to start it again."""
        process = self.process_of(name)
        words = words_of(process)
        self._signal(process, signal.SIGTERM)
        self.until(lambda: self.is_gone(process), f"{name} ends in order", 5)
        return words

    def start_again(self, words):
        self.started_again.append(
            subprocess.Popen(words, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        )

    def finish(self):
        """Ends the run in order. @returns the launch's summary; `end` is the last frame that is judged."""
        epoch, sequence = self.truth.newest.identity
        self.end = (epoch, sequence - END_OF_GRACE_FRAMES)
        if self.launch.poll() is None:
            self.launch.terminate()
        text, self.words_of_launch = self.launch.communicate(timeout=15)
        for recording in (self.merged, self.plain, self.truth):
            recording.stop()
        return exact_json.loads(text)

    def log_of(self, name):
        path = self.run_directory / f"{name}.log"
        return path.read_text() if path.exists() else ""
