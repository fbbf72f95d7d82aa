"""Recordings of a running pipeline's topics, made by `quorient echo` in processes of their own."""
import fcntl
import gc
import subprocess
import threading
import time
from typing import NamedTuple

from integration_tests.harness import exact_json

# A full garbage collection visits every sample: after some minutes it takes longer than a reader's history lasts, and delivered frames
# would count as lost. It is not needed, as no object here refers to itself.
gc.disable()

PIPE_BYTES = 1 << 20  # the most that an unprivileged process may ask for: some seconds of samples while this process is busy

FULL, DEGRADED, SINGLE, COASTING, LOST = 1, 2, 3, 4, 5
HELD = (COASTING, LOST)


class Truth(NamedTuple):
    identity: tuple
    attitude: list
    faulty: int
    arrival_s: float


class Voted(NamedTuple):
    identity: tuple
    output_sequence: int
    attitude: list
    sigma_rad: float
    reset_counter: int
    voter: int
    vouching: int
    excluded: int
    isolated: int
    mode: int
    level: int
    arrival_s: float


def parse_truth(sample, arrival_s):
    return Truth((sample["epoch"], sample["sequence_number"]), sample["attitude"], sample["faulty_mask"], arrival_s)


def parse_voted(sample, arrival_s):
    return Voted(
        (sample["epoch"], sample["sequence_number"]), sample["output_sequence"], sample["attitude"], sample["angle_sigma_rad"],
        sample["reset_counter"], sample["voter"], sample["vouching_mask"], sample["excluded_mask"], sample["isolated_mask"],
        sample["mode"], sample["level"], arrival_s,
    )


class Recording:
    """Every sample of one topic since the recording began."""

    def __init__(self, command, environment, parse):
        self.samples = []
        self._parse = parse
        self._process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        fcntl.fcntl(self._process.stdout, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def newest(self):
        return self.samples[-1] if self.samples else None

    def stop(self):
        if self._process.poll() is None:
            self._process.terminate()
        try:
            self._process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._reader.join(timeout=5)
        self._process.stdout.close()

    def _read(self):
        for line in self._process.stdout:
            if line.endswith("\n"):
                self.samples.append(self._parse(exact_json.loads(line), time.monotonic()))
