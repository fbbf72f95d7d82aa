#!/usr/bin/env python3
"""The systemd units, as systemd itself reads them, with stand-ins where the programs will be installed."""
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

UNITS = pathlib.Path(__file__).resolve().parents[2] / "deploy/systemd"
MOST_EXPOSED = 1.7


@unittest.skipUnless(shutil.which("systemd-analyze"), "systemd-analyze is not installed")
class Units(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="quorient-units-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.units = []
        for unit in [*UNITS.glob("*.service"), *UNITS.glob("*.target")]:
            # `/bin/true` stands where the program will be: verify wants an executable there.
            instance = self.folder / unit.name.replace("@", "@example")
            instance.write_text(unit.read_text().replace("/usr/bin/quorient-", "/bin/true quorient-"))
            self.units.append(instance)

    def verify(self):
        result = subprocess.run(
            ["systemd-analyze", "verify", "--man=no", *map(str, self.units)], capture_output=True, text=True, timeout=30
        )
        return [line for line in result.stderr.splitlines() if "quorient" in line]

    def test_are_understood_without_a_complaint(self):
        self.assertEqual(len(self.units), 7)
        self.assertEqual(self.verify(), [])

    def test_are_complained_about_when_a_key_is_misspelt(self):
        broken = next(unit for unit in self.units if unit.suffix == ".service")
        broken.write_text(broken.read_text().replace("WatchdogSec=", "WachtdogSec="))
        self.assertTrue(any("WachtdogSec" in line for line in self.verify()))

    def exposure(self, service):
        """The figure of systemd-analyze, from 0 (nothing) to 10."""
        result = subprocess.run(["systemd-analyze", "security", "--offline=true", "--json=off", str(service)], capture_output=True, text=True, timeout=30)
        return float(re.search(r"Overall exposure level for \S+: ([0-9.]+)", result.stdout)[1])

    def test_expose_little(self):
        for service in (unit for unit in self.units if unit.suffix == ".service"):
            with self.subTest(service.name):
                self.assertLessEqual(self.exposure(service), MOST_EXPOSED)

    def test_expose_much_without_their_restrictions(self):
        service = next(unit for unit in self.units if unit.suffix == ".service")
        restriction = re.compile(r"^(NoNewPrivileges|CapabilityBoundingSet|Protect|Private|Restrict|SystemCall|MemoryDeny|LockPersonality).*\n", re.MULTILINE)
        service.write_text(restriction.sub("", service.read_text()))
        self.assertGreater(self.exposure(service), 8)


if __name__ == "__main__":
    unittest.main(verbosity=2)
