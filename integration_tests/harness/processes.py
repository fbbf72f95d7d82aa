"""What process tests share: programs, domains, hard time-outs. No sleep is used for synchronisation."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.witness import NoQuietMachine, until_held

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ.get("QUORIENT_BIN", ROOT / "build/release/bin"))
SHARED = pathlib.Path(os.environ.get("QUORIENT_SHARED_DIR", ROOT.parent / "shared"))
DATA = pathlib.Path(os.environ.get("QUORIENT_DATA_DIR", SHARED / "data"))
CONFIGURATIONS = ROOT / "deploy/configurations"


def children_of(process):
    """Process ids of a process id's children; nothing where it has ended."""
    try:
        return list(map(int, pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()))
    except (FileNotFoundError, ProcessLookupError):
        return []


def words_of(process):
    """The command line of a process id; nothing where it has ended."""
    try:
        return pathlib.Path(f"/proc/{process}/cmdline").read_text().split("\0")[:-1]
    except (FileNotFoundError, ProcessLookupError):
        return []


class Attempt(unittest.TestResult):
    """What one attempt reported, to be reported again to the result that counts."""

    def __init__(self):
        super().__init__()
        self.calls = []

    def repeat_to(self, result):
        for method, arguments in self.calls:
            getattr(result, method)(*arguments)


def remember(method):
    def call(self, *arguments):
        getattr(unittest.TestResult, method)(self, *arguments)
        self.calls.append((method, arguments))

    return call


for outcome in ("addSuccess", "addError", "addFailure", "addSkip", "addSubTest", "addExpectedFailure", "addUnexpectedSuccess"):
    setattr(Attempt, outcome, remember(outcome))


class ProcessTest(unittest.TestCase):
    """A test with a run directory and a DDS domain of its own; every process it starts is ended by its id. A failure while the machine
    stood still is void, and the test runs again. Where it stood still in every attempt the test is skipped, and says so."""

    next_domain = 1
    needs_quiet_machine = True  # not so where nothing that is judged depends on time: such a test has one attempt on any machine

    def run(self, result):
        if not self.needs_quiet_machine:
            return super().run(result)
        attempts = []

        def attempt():
            attempts.append(Attempt())
            super(ProcessTest, self).run(attempts[-1])
            return attempts[-1].wasSuccessful()

        result.startTest(self)
        try:
            until_held(attempt)
            attempts[-1].repeat_to(result)
        except NoQuietMachine as reason:
            for _, text in attempts[-1].failures + attempts[-1].errors:
                print(text, file=sys.stderr)
            result.addSkip(self, str(reason))
        result.stopTest(self)
        return result

    def setUp(self):
        self.run_directory = pathlib.Path(tempfile.mkdtemp(prefix="quorient-test-"))
        ProcessTest.next_domain += 1
        self.domain = 120 + (os.getpid() * 7 + ProcessTest.next_domain) % 100
        self.environment = dict(os.environ, QUORIENT_RUN_DIR=str(self.run_directory))
        self.processes = []

    def tearDown(self):
        for process in self.processes:
            if process.poll() is None:
                process.kill()
            process.communicate()
        shutil.rmtree(self.run_directory, ignore_errors=True)

    def command(self, program, *arguments):
        return [str(BIN / program), *map(str, arguments)]

    def run_program(self, program, *arguments, timeout=60):
        """Runs to its end. A program that hangs fails the test."""
        return subprocess.run(
            self.command(program, *arguments), env=self.environment, capture_output=True, text=True, timeout=timeout
        )

    def start(self, program, *arguments):
        process = subprocess.Popen(
            self.command(program, *arguments), env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self.processes.append(process)
        return process

    def launch(self, configuration, *arguments, timeout=90):
        """quorient launch --json. @returns its exit code and the summary."""
        result = self.run_program("quorient", "launch", configuration, "--domain", self.domain, "--json", *arguments, timeout=timeout)
        self.assertIn(result.returncode, (0, 1), result.stdout + result.stderr)
        return result.returncode, exact_json.loads(result.stdout), result.stderr

    def eventually(self, condition, what, timeout=20):
        """Polls until the condition holds; a hard time-out, not a wait."""
        deadline = time.monotonic() + timeout
        while not condition():
            self.assertLess(time.monotonic(), deadline, f"not within {timeout} s: {what}")
            time.sleep(0.02)

    def heartbeat(self, name):
        """The file in which that process of unit 1 leaves its heartbeat."""
        return self.run_directory / f"{name}.{self.domain}.1.heartbeat"

    def write(self, name, text):
        path = self.run_directory / name
        path.write_text(text)
        return path
