#!/usr/bin/env python3
"""The systemd units, as systemd itself reads them, with stand-ins where the programs will be installed."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

UNITS = pathlib.Path(__file__).resolve().parents[2] / "deploy/systemd"


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

    def test_expose_little(self):
        service = next(unit for unit in self.units if unit.suffix == ".service")
        result = subprocess.run(
            ["systemd-analyze", "security", "--offline=true", "--threshold=30", str(service)], capture_output=True, text=True, timeout=30
        )
        self.assertEqual(result.returncode, 0, result.stdout[-300:] + result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
