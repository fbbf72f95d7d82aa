"""The services need no system call, socket family or writable code that the systemd units deny: on both vendors, with DDS Security."""
import functools
import re
import shutil
import subprocess
import sys
import unittest

from integration_tests.harness.processes import CONFIGURATIONS, ROOT, ProcessTest

UNITS = ROOT / "deploy/systemd"
CHECKED_BY_ARGUMENT = ("socket", "mmap", "mprotect")


def setting(unit, key):
    return [value for value in re.findall(rf"^{key}=(.*)$", unit.read_text(), re.MULTILINE)]


@functools.cache
def calls_of(group):
    """The system calls of a systemd group such as @system-service."""
    if not group.startswith("@"):
        return frozenset([group])
    listed = subprocess.run(["systemd-analyze", "syscall-filter", group], check=True, capture_output=True, text=True, timeout=30).stdout
    words = [line.strip() for line in listed.splitlines()[1:] if line.strip() and not line.strip().startswith("#")]
    return frozenset().union(*map(calls_of, words))


def allowed_calls(unit):
    allowed = set()
    for line in setting(unit, "SystemCallFilter"):
        for word in line.removeprefix("~").split():
            allowed = allowed - calls_of(word) if line.startswith("~") else allowed | calls_of(word)
    return allowed


def denied(unit, command, folder, environment, timeout):
    """Runs a command to its end. @returns what it and its children did that the unit denies."""
    log = folder / "calls.txt"
    quiet = ",".join(f"?{call}" for call in sorted(allowed_calls(unit) - set(CHECKED_BY_ARGUMENT)))
    traced = subprocess.run(["strace", "-f", "--seccomp-bpf", "-qq", "-e", "signal=none", "-e", f"trace=!{quiet}", "-o", log, *map(str, command)],
                            env=environment, capture_output=True, text=True, timeout=timeout)
    families = setting(unit, "RestrictAddressFamilies")[0].split()
    found = set()
    for call, arguments in re.findall(r"^\d+ +(\w+)\((.*)", log.read_text(), re.MULTILINE):
        if call == "socket":
            family = arguments.split(",")[0]
            found |= {f"socket of {family}"} - {f"socket of {known}" for known in families}
        elif call in ("mmap", "mprotect"):
            found |= {"writable code"} if "PROT_WRITE" in arguments and "PROT_EXEC" in arguments else set()
        elif call not in ("execve", "exit", "exit_group"):
            found.add(call)
    return found, traced


@unittest.skipUnless(shutil.which("strace") and shutil.which("systemd-analyze"), "strace or systemd-analyze is not installed")
class UnitLimits(ProcessTest):
    def setUp(self):
        super().setUp()
        self.units = sorted(UNITS.glob("*.service"))

    def test_are_the_same_in_every_unit(self):
        self.assertEqual(len(self.units), 6)
        for key in ("SystemCallFilter", "RestrictAddressFamilies", "MemoryDenyWriteExecute"):
            self.assertEqual(len({tuple(setting(unit, key)) for unit in self.units}), 1, key)

    def test_are_kept_by_the_secured_demo_on_both_vendors(self):
        keys = self.run_directory / "keys"
        made = self.run_program("quorient", "keys", CONFIGURATIONS / "demo.yaml", "--out", keys, "--domain", self.domain)
        self.assertEqual(made.returncode, 0, made.stderr)
        launch = self.command("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--set", f"security.directory={keys}",
                              "--set", "source.duration_s=4", "--set", "source.rate_hz=50", "--set", "expect=null", "--json")
        found, launched = denied(self.units[0], launch, self.run_directory, self.environment, timeout=90)
        self.assertEqual(launched.returncode, 0, launched.stderr)
        self.assertEqual(found, set())

    def test_are_seen_to_be_broken_by_a_program_that_breaks_them(self):
        own = str(self.run_directory)  # the sources may be read-only
        broken = f"import os, socket, mmap; os.chown({own!r}, -1, -1); mmap.mmap(-1, 4096, prot=7); socket.socket(socket.AF_PACKET)"
        found, _ = denied(self.units[0], [sys.executable, "-c", broken], self.run_directory, self.environment, timeout=30)
        self.assertEqual(found, {"chown", "socket of AF_PACKET", "writable code"})


if __name__ == "__main__":
    unittest.main()
