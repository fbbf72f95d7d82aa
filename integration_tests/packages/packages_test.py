#!/usr/bin/env python3
"""The installed package is complete: its programs run without the sources, and find_package(quorient) builds a consumer."""
import gzip
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ.get("QUORIENT_BUILD", pathlib.Path(__file__).resolve().parents[2] / "build/release"))
COMPILER = os.environ.get("QUORIENT_COMPILER", "c++")
CONSUMER = pathlib.Path(__file__).resolve().parent / "consumer"


def run(*command, **options):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=200, **options)


@unittest.skipUnless((BUILD / "bin/quorient-voter").exists(), f"nothing is built in {BUILD}")
class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="quorient-installed-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.prefix = cls.folder / "usr"
        installed = run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        assert installed.returncode == 0, installed.stderr

    def test_programs_explain_themselves_with_a_manual_page_and_the_demo_runs(self):
        for program in ("quorient", "quorient-sensor", "quorient-fdi", "quorient-attitude", "quorient-voter", "quorient-monitor", "quorient-run"):
            helped = run(self.prefix / "bin" / program, "--help")
            self.assertEqual(helped.returncode, 0, program)
            self.assertIn("Usage", helped.stdout)
            manual = self.manual_of(program)
            self.assertIn(f".TH {program.upper()} 1", manual)
            self.assertIn(r"\-\-help", manual)
            self.assertNotIn(str(BUILD), manual, "the page names the build machine")
        self.assertIn(".SH LAUNCH", self.manual_of("quorient"))
        with gzip.open(self.prefix / "share/man/man5/quorient-system.5.gz", "rt") as page:
            self.assertIn("level_window: whole number, 1 to 32", page.read())
        launched = run(
            self.prefix / "bin/quorient", "launch", self.prefix / "share/quorient/demo.yaml", "--json", "--domain", 119,
            "--set", "source.duration_s=1", "--set", "expect=null", env=dict(os.environ, QUORIENT_RUN_DIR=str(self.folder / "run")),
        )
        self.assertEqual(launched.returncode, 0, launched.stderr)

    def manual_of(self, program):
        with gzip.open(self.prefix / f"share/man/man1/{program}.1.gz", "rt") as page:
            return page.read()

    def test_consumer_outside_the_tree_builds_and_isolates_an_axis(self):
        build = self.folder / "consumer"
        configured = run(
            "cmake", "-S", CONSUMER, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={COMPILER}",
            "-DCMAKE_BUILD_TYPE=Release",
        )
        self.assertEqual(configured.returncode, 0, configured.stdout + configured.stderr)
        built = run("cmake", "--build", build)
        self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
        self.assertEqual(run(build / "consumer").stdout, "2\n")

    def test_nothing_installed_names_the_build_machine(self):
        for file in (self.prefix / "lib").rglob("*.cmake"):
            self.assertNotIn(str(BUILD), file.read_text(), file)


if __name__ == "__main__":
    unittest.main(verbosity=2)
