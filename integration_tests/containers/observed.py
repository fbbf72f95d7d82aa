"""What the observer's container receives, line by line, while it receives it."""
import json
import subprocess
import threading
from typing import NamedTuple

from integration_tests.harness.streams import parse_truth, parse_voted


class Event(NamedTuple):
    source: str
    identity: tuple
    code: int
    severity: int
    text: str
    arrival_s: float


class Status(NamedTuple):
    name: str
    vendor: int
    transport: int


class Stall(NamedTuple):
    """The observer's thread that only sleeps was not let run."""

    begin_s: float
    end_s: float


def parse_event(sample):
    identity = (sample["epoch"], sample["sequence_number"])
    return Event(sample["source_name"], identity, sample["code"], sample["severity"], sample["text"], sample["arrival_s"])


def parse_status(sample):
    return Status(sample["name"], sample["vendor"], sample["transport"])


class Observed:
    """Use as a context. Lists grow while the observer lives."""

    def __init__(self, container):
        self.merged, self.plain, self.truth, self.events, self.stalls = [], [], [], [], []
        self.statuses = {}
        self.unreadable = 0
        self._take = {
            "voter_output": lambda sample: self.merged.append(parse_voted(sample, sample["arrival_s"])),
            "voted": lambda sample: self.plain.append(parse_voted(sample, sample["arrival_s"])),
            "truth": lambda sample: self.truth.append(parse_truth(sample, sample["arrival_s"])),
            "event": lambda sample: self.events.append(parse_event(sample)),
            "status": lambda sample: self.statuses.update({sample["name"]: parse_status(sample)}),
            "stall": lambda sample: self.stalls.append(Stall(sample["begin_s"], sample["end_s"])),
        }
        self._process = subprocess.Popen(
            ["docker", "logs", "--follow", container], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._process.poll() is None:
            self._process.terminate()
        self._process.wait()
        self._reader.join(timeout=5)
        self._process.stdout.close()

    def _read(self):
        for line in self._process.stdout:
            topic, _, text = line.partition(" ")
            try:
                self._take[topic](json.loads(text))
            except (KeyError, json.JSONDecodeError):
                self.unreadable += 1

    def newest(self):
        """Identity of the newest voted frame; None before the first."""
        return self.merged[-1].identity if self.merged else None

    def longest_stall_s(self, begin_s):
        return max((stall.end_s - stall.begin_s for stall in self.stalls if stall.end_s >= begin_s), default=0.0)
