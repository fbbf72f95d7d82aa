"""One rule of exit codes for all verbs: a table of verbs times outcomes. `python3 -m integration_tests.processes.exit_codes_test --table` prints it."""
import os
import re
import subprocess
import sys
import unittest

from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest

DONE, NOT_AS_ASKED, REFUSED = 0, 1, 2
DEMO = CONFIGURATIONS / "demo.yaml"
CONE = ("--layout", "cone-4")
SIMULATED = ("rest", *CONE, "--interval", 0.01)
VECTOR = ("--method", "vector", *CONE, "--tolerance", 1e-6)
SOON = ("--domain", "{domain}")

# Verb -> outcome -> arguments. {folder} has rows.csv (four axes), six.csv, body.csv (three), header.csv, empty.csv, taken (exists) and demo.yaml.
CELLS = {
    "layout": {"done": ("cone-4",), "bad usage": ("cone-4", "--without", 9), "bad input": ("--axes", "{folder}/no.csv"), "nothing to do": ("--axes", "{folder}/empty.csv")},
    "assess": {"done": (*VECTOR, "{folder}/rows.csv"), "not as asked": (*VECTOR, "{folder}/rows.csv", "--check", "isolated"), "bad usage": (*VECTOR, "--sigma", -1),
               "bad input": (*VECTOR, "{folder}/body.csv"), "nothing to do": (*VECTOR, "{folder}/header.csv")},
    "propagate": {"done": ("--interval", 0.01, "{folder}/body.csv"), "bad usage": ("--interval", -1, "{folder}/body.csv"), "bad input": ("--interval", 0.01, "{folder}/rows.csv"),
                  "nothing to do": ("--interval", 0.01, "{folder}/empty.csv")},
    "simulate": {"done": (*SIMULATED, "--duration", 0.1), "bad usage": (*SIMULATED, "--duration", -1), "bad input": ("rest", "--axes", "{folder}/no.csv"),
                 "nothing to do": (*SIMULATED, "--duration", 0.001)},
    "vessel": {"done": ("--duration", 1), "bad usage": ("--duration", "nan"), "bad input": ("--vessel", "{folder}/no.yaml"), "file not written": ("--duration", 1, "--plot", "/dev/full"),
               "file exists": ("--duration", 1, "--plot", "{folder}/taken")},
    "calibrate": {"done": ("{folder}/rest.csv", *CONE), "bad usage": ("{folder}/rest.csv", *CONE, "--rest-s", 0), "bad input": ("{folder}/no.csv", *CONE),
                  "nothing to do": ("{folder}/empty.csv", *CONE), "file not written": ("{folder}/rest.csv", *CONE, "--out", "/dev/full"),
                  "file exists": ("{folder}/rest.csv", *CONE, "--out", "{folder}/taken")},
    "replay": {"done": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml"), "bad usage": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml", "--from", 1, "--to", 0.5),
               "bad input": ("{folder}/no.csv", "--system", "{folder}/demo.yaml"), "nothing to do": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml", "--from", 1000)},
    "design": {"done": ("--axes", 4, "--starts", 1, "--designs", 1), "bad usage": ("--axes", -1), "bad input": ("{folder}/no.yaml",), "nothing to do": ()},
    "diagnose": {"done": ("{folder}/triads.csv",), "bad usage": ("{folder}/triads.csv", "--lsb-per-deg-s", 0), "bad input": ("{folder}/no.csv",), "nothing to do": ("{folder}/empty.csv",)},
    "keys": {"bad usage": ("--days", 0), "bad input": ("{folder}/no.yaml", "--out", "{folder}/keys"), "nothing to do": ("--out", "{folder}/keys")},
    "check": {"done": (DEMO,), "bad usage": (DEMO, "--key"), "bad input": (DEMO, "--set", "source.rate_hz=0"), "nothing to do": ()},
    "launch": {"bad usage": (DEMO, "--duration", -1), "bad input": (DEMO, "--set", "source.rate_hz=0")},
    "echo": {"not as asked": ("frame", "--count", 1, "--timeout", 0.1, *SOON), "bad usage": ("frame", "--timeout", -1), "bad input": ("frames", *SOON)},
    "status": {"not as asked": ("--seconds", 0.1, *SOON), "bad usage": ("--seconds", 0), "bad input": ("--interface", "nowhere0")},
    "inject": {"bad usage": ("--unit", -1, "axis=0,kind=zero"), "bad input": ("axis=0,kind=tired",)},
    "readmit": {"bad usage": ("--axis", 99)},
    "reset": {"bad usage": ("--attitude", "1,0,0")},
    "record": {"not as asked": ("{folder}/new", "--duration", 0.1, *SOON), "bad usage": ("{folder}/new", "--duration", -1), "bad input": ("{folder}/no/new", *SOON),
               "file exists": ("{folder}/taken", *SOON)},
    "health": {"not as asked": ("nobody",), "bad usage": ("nobody", "--fresh", 0)},
    "clean": {"done": ("--dry-run",), "bad usage": ("--dry",)},
}
CODES = {"done": DONE, "not as asked": NOT_AS_ASKED, "bad usage": REFUSED, "bad input": REFUSED, "nothing to do": REFUSED, "file not written": REFUSED, "file exists": REFUSED}
PRINTING = ("layout", "assess", "propagate", "simulate", "vessel", "calibrate", "replay", "check")


class ExitCodes(ProcessTest):
    def setUp(self):
        super().setUp()
        self.write("empty.csv", "")
        self.write("taken", "mine\n")
        self.write("header.csv", "a,b,c,d\n")
        self.write("body.csv", "0,0,0.01\n" * 12)
        self.write("rows.csv", "0,0,0,0\n" * 12)
        self.write("rest.csv", self.verb("simulate", *SIMULATED, "--duration", 20, "--noise-rad", 1e-6).stdout)
        self.write("triads.csv", self.verb("simulate", "rest", "--layout", "triads-3", "--interval", 0.01, "--duration", 20, "--noise-rad", 1e-6).stdout)
        self.write("demo.yaml", "unit: {layout: cone-4}\nsource: {kind: log, file: rest.csv, rate_hz: 100, noise_rad: 1.0e-6}\n"
                                "lanes: [{name: a, detector: {method: vector}}]\nvoters: [{name: v}]\n")

    def verb(self, verb, *arguments, timeout=30, **options):
        filled = [str(argument).format(folder=self.run_directory, domain=self.domain) for argument in arguments]
        options = {"stdout": subprocess.PIPE, "stdin": subprocess.DEVNULL, **options}
        return subprocess.run(self.command("quorient", verb, *filled), env=self.environment, stderr=subprocess.PIPE, text=True, timeout=timeout, **options)

    def test_are_the_same_for_all_verbs(self):
        for verb, outcomes in CELLS.items():
            for outcome, arguments in outcomes.items():
                with self.subTest(verb=verb, outcome=outcome):
                    ended = self.verb(verb, *arguments)
                    self.assertEqual(ended.returncode, CODES[outcome], ended.stderr)
                    if CODES[outcome] != DONE and (verb, outcome) != ("assess", "not as asked") and (verb, outcome) != ("echo", "not as asked"):
                        self.assertNotEqual(ended.stderr.strip(), "", "no word why")
        self.assertEqual((self.run_directory / "taken").read_text(), "mine\n")
        self.assertFalse((self.run_directory / "new").exists(), "a failed start left a file behind")

    def test_have_a_line_for_every_verb_and_stand_in_its_help(self):
        listed = re.findall(r"^  (\w+)  ", self.verb("--help").stdout.split("Subcommands:")[1], re.M)
        self.assertEqual(set(listed), set(CELLS))
        for verb in listed:
            ended = self.verb(verb, "--help")
            self.assertEqual(ended.returncode, DONE)
            self.assertIn("Exit codes:\n  0  done", ended.stdout, verb)
            self.assertEqual("\n  1  " in ended.stdout, "not as asked" in CELLS.get(verb, {}) or verb in ("launch", "inject", "readmit", "reset", "clean", "design", "diagnose"), verb)

    def test_of_a_full_standard_output_and_a_closed_one_are_those_of_a_refusal(self):
        for verb in PRINTING:
            with self.subTest(verb=verb), open("/dev/full", "w") as full:
                ended = self.verb(verb, *CELLS[verb]["done"], stdout=full)
                self.assertEqual(ended.returncode, REFUSED)
                self.assertIn("No space left on device", ended.stderr)
        reading, writing = os.pipe()
        os.close(reading)
        with os.fdopen(writing, "w") as closed:
            ended = self.verb("simulate", *SIMULATED, "--duration", 100, stdout=closed)
        self.assertEqual(ended.returncode, REFUSED)
        self.assertIn("standard output cannot be written", ended.stderr)

    def test_of_an_existing_file_is_done_with_force(self):
        ended = self.verb("calibrate", *CELLS["calibrate"]["file exists"], "--force")
        self.assertEqual(ended.returncode, DONE, ended.stderr)
        self.assertIn("axes", (self.run_directory / "taken").read_text())

    def test_of_a_launch_without_a_frame_is_not_as_asked(self):
        ended = self.verb("launch", DEMO, "--duration", 0.05, "--domain", "{domain}", "--set", "expect=null")
        self.assertEqual(ended.returncode, NOT_AS_ASKED)
        self.assertIn("no frame came", ended.stderr)


class Record(ProcessTest):
    def setUp(self):
        super().setUp()
        self.start("quorient", "launch", DEMO, "--domain", self.domain, "--json", "--set", "source.duration_s=120", "--set", "expect=null")
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs")

    def test_on_a_full_disk_keeps_whole_rows_and_says_how_many(self):
        script = 'mount -t tmpfs -o size=16k none "$1" || exit 77; "$2" record "$1/flight.csv" --domain "$3" --duration 20; code=$?; cat "$1/flight.csv"; exit $code'
        disk = self.run_directory / "disk"
        disk.mkdir()
        ended = subprocess.run(
            ["unshare", "-m", "sh", "-c", script, "sh", disk, *self.command("quorient"), str(self.domain)], env=self.environment, capture_output=True, text=True, timeout=60
        )
        if ended.returncode in (1, 77) and "record" not in ended.stderr and "frames" not in ended.stderr:
            self.skipTest(f"no disk of its own: {ended.stderr}")
        self.assertEqual(ended.returncode, REFUSED, ended.stderr)
        header, *rows = ended.stdout.splitlines()
        self.assertIn(f"No space left on device; the first {len(rows)} frames are in it", ended.stderr)
        self.assertGreater(len(rows), 50)
        self.assertEqual({row.count(",") for row in rows}, {header.count(",")})
        self.assertTrue(ended.stdout.endswith("\n"), "the last row is cut")

    def test_counts_what_is_in_the_file(self):
        ended = self.run_program("quorient", "record", self.run_directory / "flight.csv", "--domain", self.domain, "--duration", 1.5)
        self.assertEqual(ended.returncode, DONE, ended.stderr)
        rows = (self.run_directory / "flight.csv").read_text().splitlines()
        self.assertIn(f": {len(rows) - 1} frames", ended.stderr)

    def test_of_another_unit_says_which_units_there_are(self):
        ended = self.run_program("quorient", "record", self.run_directory / "flight.csv", "--domain", self.domain, "--unit", 7, "--duration", 1.5)
        self.assertEqual(ended.returncode, NOT_AS_ASKED)
        self.assertIn("no frame of unit 7 came", ended.stderr)
        self.assertIn("there are frames of unit 1", ended.stderr)
        self.assertFalse((self.run_directory / "flight.csv").exists())


def print_table():
    print("| verb |", " | ".join(CODES), "|\n|---|" + "---|" * len(CODES))
    for verb, outcomes in CELLS.items():
        print(f"| {verb} |", " | ".join(str(CODES[outcome]) if outcome in outcomes else "" for outcome in CODES), "|")


if __name__ == "__main__":
    if "--table" in sys.argv:
        print_table()
    else:
        unittest.main(verbosity=2)
