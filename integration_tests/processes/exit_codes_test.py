"""One rule of exit codes for all verbs: a table of verbs times outcomes. `python3 -m integration_tests.processes.exit_codes_test --table` measures it."""
import functools
import os
import re
import subprocess
import sys
import unittest

from integration_tests.harness import exact_json
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
    "vessel": {"done": ("--duration", 1), "bad usage": ("--duration", "nan"), "bad input": ("--vessel", "{folder}/no.yaml"), "file exists": ("--duration", 1, "--plot", "{folder}/taken")},
    "calibrate": {"done": ("{folder}/rest.csv", *CONE), "not as asked": ("--live", "{folder}/live.yaml", "--domain", "{quiet}", "--duration", 0.5),
                  "bad usage": ("{folder}/rest.csv", *CONE, "--rest-s", 0), "bad input": ("{folder}/no.csv", *CONE),
                  "nothing to do": ("{folder}/empty.csv", *CONE), "file exists": ("{folder}/rest.csv", *CONE, "--out", "{folder}/taken")},
    "replay": {"done": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml"), "bad usage": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml", "--from", 1, "--to", 0.5),
               "bad input": ("{folder}/no.csv", "--system", "{folder}/demo.yaml"), "nothing to do": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml", "--from", 1000),
               "not as asked": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml", "--set", "expect={isolated: [1]}"),
               "disk full": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml", "--verdicts", "/dev/full"),
               "file exists": ("{folder}/rest.csv", "--system", "{folder}/demo.yaml", "--events", "{folder}/taken")},
    "design": {"done": ("--axes", 4, "--starts", 1, "--designs", 1), "bad usage": ("--axes", -1), "bad input": ("{folder}/no.yaml",), "nothing to do": ()},
    "diagnose": {"done": ("{folder}/triads.csv",), "bad usage": ("{folder}/triads.csv", "--lsb-per-deg-s", 0), "bad input": ("{folder}/no.csv",), "nothing to do": ("{folder}/empty.csv",),
                 "file exists": ("{folder}/triads.csv", "--html", "{folder}/taken")},
    "keys": {"done": (DEMO, "--out", "{folder}/keys"), "bad usage": ("--days", 0), "bad input": ("{folder}/no.yaml", "--out", "{folder}/keys"), "nothing to do": ("--out", "{folder}/keys"),
             "file exists": (DEMO, "--out", "{folder}/taken")},
    "check": {"done": (DEMO,), "bad usage": (DEMO, "--key"), "bad input": (DEMO, "--set", "source.rate_hz=0"), "nothing to do": ()},
    "launch": {"not as asked": (DEMO, "--duration", 0.05, "--set", "expect=null", *SOON), "bad usage": (DEMO, "--duration", -1), "bad input": (DEMO, "--set", "source.rate_hz=0")},
    "echo": {"not as asked": ("frame", "--count", 1, "--timeout", 0.1, *SOON), "bad usage": ("frame", "--timeout", -1), "bad input": ("frames", *SOON)},
    "status": {"not as asked": ("--seconds", 0.1, *SOON), "bad usage": ("--seconds", 0), "bad input": ("--interface", "nowhere0")},
    "inject": {"bad usage": ("--clear", "axis=0,kind=zero"), "bad input": ("axis=0,kind=tired",), "nothing to do": ()},
    "readmit": {"bad usage": ("--axis", 99)},
    "reset": {"bad usage": ("--attitude", "1,0,0")},
    "record": {"not as asked": ("{folder}/new", "--duration", 0.1, *SOON), "bad usage": ("{folder}/new", "--duration", -1), "bad input": ("{folder}/no/new", *SOON),
               "file exists": ("{folder}/taken", *SOON)},
    "health": {"not as asked": ("nobody",), "bad usage": ("nobody", "--fresh", 0)},
    "clean": {"done": ("--dry-run",), "bad usage": ("--dry",)},
}
# What a verb answers while a system runs, in this order: axis 2 breaks, heals and is readmitted.
LIVE = {
    "launch": {"bad input": ("{folder}/live.yaml", *SOON, "--duration", 1), "done": ("{folder}/short.yaml", "--domain", "{quiet}")},
    "echo": {"done": ("frame", "--count", 1, "--timeout", 10, *SOON)},
    "status": {"done": ("--seconds", 1, *SOON)},
    "inject": {"done": ("axis=2,kind=bias,value=0.05,start=0", *SOON), "not as asked": ("axis=9,kind=zero", *SOON)},
    "readmit": {"done": ("--axis", 2, *SOON), "not as asked": ("--axis", 0, *SOON)},
    "reset": {"done": ("--attitude", "1,0,0,0", *SOON), "not as asked": ("--attitude", "1,0,0,0", "--domain", "{quiet}")},
    "record": {"done": ("{folder}/live.csv", "--force", "--duration", 1, *SOON)},
    "health": {"done": ("voter-1", *SOON)},  # the short run on the quiet domain left heartbeats, too
}
# Verbs that write files. {disk} is full, or read-only.
WRITING = {
    "vessel": ("--duration", 1, "--plot", "{disk}/plot.svg"),
    "calibrate": ("{folder}/rest.csv", *CONE, "--out", "{disk}/cluster.yaml"),
    "diagnose": ("{folder}/triads.csv", "--html", "{disk}/page.html"),
    "design": ("--axes", 4, "--starts", 1, "--designs", 1, "--out", "{disk}/designs"),
    "keys": (DEMO, "--out", "{disk}/keys"),
    "record": ("{disk}/live.csv", "--duration", 1, *SOON),
}
PRINTS_NOTHING = ("record", "clean")  # on standard output; nothing is left to clean in these tests
CODES = {"done": DONE, "not as asked": NOT_AS_ASKED, "bad usage": REFUSED, "bad input": REFUSED, "nothing to do": REFUSED, "file exists": REFUSED,
         "disk full": REFUSED, "read-only disk": REFUSED, "output full": REFUSED, "output closed": REFUSED}
SPEAKS_ON_STDOUT = {("assess", "not as asked"), ("inject", "not as asked"), ("readmit", "not as asked")}  # rows, and the answers of services

LIVE_SYSTEM = """
unit: {{id: 1, layout: dodecahedron}}
source: {{motion: {{kind: coning, k2: 0.084, k3: 0.05}}, duration_s: {duration_s}, noise_rad: 1.0e-6}}
lanes: [{{name: a, detector: {{method: subset}}}}, {{name: b, detector: {{method: glt}}}}, {{name: c, detector: {{method: subset}}}}]
voters: [{{name: voter-1}}, {{name: voter-2}}]
"""
DISK = """
mount -t tmpfs -o size=4k none "$1" && head -c 4096 /dev/zero > "$1/filler" || exit 77
[ "$2" != "read-only disk" ] || mount -o remount,ro "$1" || exit 77
shift 2; exec "$@"
"""


class VerbsTest(ProcessTest):
    def setUp(self):
        super().setUp()
        self.quiet = self.domain + 1 if self.domain % 2 else self.domain - 1
        self.write("empty.csv", "")
        self.write("taken", "mine\n")
        self.write("header.csv", "a,b,c,d\n")
        self.write("body.csv", "0,0,0.01\n" * 12)
        self.write("rows.csv", "0,0,0,0\n" * 12)
        self.write("rest.csv", self.verb("simulate", *SIMULATED, "--duration", 20, "--noise-rad", 1e-6).stdout)
        self.write("triads.csv", self.verb("simulate", "rest", "--layout", "triads-3", "--interval", 0.01, "--duration", 20, "--noise-rad", 1e-6).stdout)
        self.write("demo.yaml", "unit: {layout: cone-4}\nsource: {kind: log, file: rest.csv, rate_hz: 100, noise_rad: 1.0e-6}\n"
                                "lanes: [{name: a, detector: {method: vector}}]\nvoters: [{name: v}]\n")
        self.write("live.yaml", LIVE_SYSTEM.format(duration_s=300))
        self.write("short.yaml", LIVE_SYSTEM.format(duration_s=1))
        (self.run_directory / "disk").mkdir()

    def filled(self, arguments):
        """With the places in braces filled in; other braces are YAML."""
        places = {"{folder}": self.run_directory, "{disk}": self.run_directory / "disk", "{domain}": self.domain, "{quiet}": self.quiet}
        return [functools.reduce(lambda text, place: text.replace(place, str(places[place])), places, str(argument)) for argument in arguments]

    def verb(self, verb, *arguments, before=(), timeout=60, **options):
        options = {"stdout": subprocess.PIPE, "stdin": subprocess.DEVNULL, **options}
        return subprocess.run([*map(str, before), *self.command("quorient", verb, *self.filled(arguments))], env=self.environment, stderr=subprocess.PIPE, text=True, timeout=timeout,
                              **options)

    def on_disk(self, verb, outcome):
        """With a disk of its own that is full or read-only."""
        before = ("unshare", "-m", "sh", "-c", DISK, "sh", self.run_directory / "disk", outcome)
        ended = self.verb(verb, *WRITING[verb], before=before)
        if ended.returncode in (1, 77) and "unshare" in ended.stderr + "unshare" * (ended.returncode == 77):
            self.skipTest(f"no disk of its own: {ended.stderr}")
        return ended

    def with_output_full(self, verb, arguments):
        with open("/dev/full", "w") as full:
            return self.verb(verb, *arguments, stdout=full)

    def with_output_closed(self, verb, arguments):
        reading, writing = os.pipe()
        os.close(reading)
        with os.fdopen(writing, "w") as closed:
            return self.verb(verb, *arguments, stdout=closed)

    def start_live_system(self):
        live = self.start("quorient", "launch", self.run_directory / "live.yaml", "--domain", self.domain, "--json")
        self.eventually(lambda: self.verb("health", "voter-1").returncode == 0, "the system runs")
        return live

    def isolated(self):
        """Whether all three lanes isolate axis 2, or none does."""
        ended = self.verb("echo", "verdict", "--json", "--count", 250, "--timeout", 5, *SOON)  # behind each history of 64
        masks = {}
        for line in ended.stdout.splitlines():
            verdict = exact_json.loads(line)
            masks[verdict["detector"]] = verdict["isolated_mask"]
        return set(masks.values()) == {0b100} and len(masks) == 3

    def prepare(self, verb, outcome):
        """What has to be before a live cell."""
        if (verb, outcome) == ("readmit", "done"):
            self.eventually(self.isolated, "axis 2 is isolated by every lane")
            self.assertEqual(self.verb("inject", "--clear", *SOON).returncode, DONE)

    def offline_cells(self):
        """Every cell that needs no running system: (verb, outcome, how it ended)."""
        for verb, outcomes in CELLS.items():
            for outcome, arguments in outcomes.items():
                yield verb, outcome, self.verb(verb, *arguments)
            if "done" in outcomes and verb not in PRINTS_NOTHING:
                yield verb, "output full", self.with_output_full(verb, outcomes["done"])
                yield verb, "output closed", self.with_output_closed(verb, outcomes["done"])
        for verb in WRITING:
            if verb not in LIVE:
                for outcome in ("disk full", "read-only disk"):
                    yield verb, outcome, self.on_disk(verb, outcome)

    def live_cells(self):
        """The cells of a running system, in the order of LIVE."""
        for verb, outcomes in LIVE.items():
            for outcome, arguments in outcomes.items():
                self.prepare(verb, outcome)
                yield verb, outcome, self.verb(verb, *arguments)
            if verb not in ("record", "readmit"):  # what is readmitted already is not readmitted again
                yield verb, "output full", self.with_output_full(verb, outcomes["done"])
                yield verb, "output closed", self.with_output_closed(verb, outcomes["done"])
        for outcome in ("disk full", "read-only disk"):
            yield "record", outcome, self.on_disk("record", outcome)

    def judge(self, verb, outcome, ended):
        with self.subTest(verb=verb, outcome=outcome):
            self.assertEqual(ended.returncode, CODES[outcome], ended.stderr)
            if CODES[outcome] != DONE and (verb, outcome) not in SPEAKS_ON_STDOUT:
                self.assertNotEqual(ended.stderr.strip(), "", "no word why")
            if outcome == "nothing to do":
                self.assertEqual(ended.stdout, "", "an output of nothing")
            if outcome.startswith("output"):
                self.assertIn("standard output cannot be written", ended.stderr)
            if outcome == "disk full":
                self.assertIn("No space left on device", ended.stderr)
            if outcome == "read-only disk":
                self.assertIn("Read-only file system", ended.stderr)


class ExitCodes(VerbsTest):
    def test_are_the_same_for_all_verbs(self):
        for cell in self.offline_cells():
            self.judge(*cell)
        self.assertEqual((self.run_directory / "taken").read_text(), "mine\n")
        self.assertFalse((self.run_directory / "new").exists(), "a failed start left a file behind")

    def test_are_the_same_beside_a_running_system(self):
        live = self.start_live_system()
        for cell in self.live_cells():
            self.judge(*cell)
        self.assertIsNone(live.poll(), "the running system went on")

    def test_have_a_line_for_every_verb_and_stand_in_its_help(self):
        listed = re.findall(r"^  (\w+)  ", self.verb("--help").stdout.split("Subcommands:")[1], re.M)
        self.assertEqual(set(listed), set(CELLS))
        for verb in listed:
            ended = self.verb(verb, "--help")
            self.assertEqual(ended.returncode, DONE)
            self.assertIn("Exit codes:\n  0  done", ended.stdout, verb)
            asked = "not as asked" in CELLS[verb] or "not as asked" in LIVE.get(verb, {}) or verb in ("clean", "design", "diagnose")
            self.assertEqual("\n  1  " in ended.stdout, asked, verb)

    def test_of_an_existing_file_is_done_with_force(self):
        ended = self.verb("calibrate", *CELLS["calibrate"]["file exists"], "--force")
        self.assertEqual(ended.returncode, DONE, ended.stderr)
        self.assertIn("axes", (self.run_directory / "taken").read_text())

    def test_of_a_launch_without_a_frame_says_so(self):
        self.assertIn("no frame came", self.verb("launch", *CELLS["launch"]["not as asked"]).stderr)

    def test_of_health_never_answer_for_another_system(self):
        self.start_live_system()
        other = self.start("quorient", "launch", self.run_directory / "live.yaml", "--domain", self.quiet, "--json", "--set", "name=other")
        self.eventually(lambda: self.verb("health", "voter-1", "--domain", "{quiet}").returncode == 0, "the other system runs")
        both = self.verb("health", "voter-1")
        self.assertEqual(both.returncode, REFUSED)
        self.assertIn("several processes have this name", both.stderr)
        other.kill()
        other.wait(10)
        self.eventually(lambda: self.verb("health", "voter-1", "--domain", "{quiet}").returncode == NOT_AS_ASKED, "the other system's heartbeat is stale")
        self.assertEqual(self.verb("health", "voter-1", *SOON).returncode, DONE)


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


PAGE = """# Verbs and exit codes

How each verb ends. 0: done. 1: not as asked. 2: bad usage, bad input, nothing to do, or an output that cannot be written.
Empty: the verb has no such outcome, or another test shows it (`live_verbs`, `demo`, `access`).

Every figure is measured: `python3 -m integration_tests.processes.exit_codes_test --table` runs each cell and prints this page; the test of the same
name compares each with the rule. "Output full" is `/dev/full` as standard output, "output closed" a pipe that nobody reads. A full disk and a read-only one
are mounted for the cell. The test also records to a disk of 16 kB until that is full: 2, and whole rows only.
"""


def print_table():
    cells = {}
    test = VerbsTest()
    test.setUp()
    try:
        for verb, outcome, ended in test.offline_cells():
            cells[verb, outcome] = ended.returncode
        test.start_live_system()
        for verb, outcome, ended in test.live_cells():
            cells[verb, outcome] = ended.returncode
    finally:
        test.tearDown()
    print(PAGE)
    print("| verb |", " | ".join(CODES), "|\n|---|" + "---|" * len(CODES))
    for verb in CELLS:
        print(f"| {verb} |", " | ".join(str(cells.get((verb, outcome), "")) for outcome in CODES), "|")


if __name__ == "__main__":
    if "--table" in sys.argv:
        print_table()
    else:
        unittest.main(verbosity=2)
