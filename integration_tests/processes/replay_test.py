"""quorient replay: the whole system offline, the same bytes on every run."""
import csv
import itertools
import json
import math
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.processes import BIN, CONFIGURATIONS, DATA, ProcessTest
from integration_tests.harness.quaternion import angle

RECORDING = DATA / "mimu4444_carlsson/exp_1/data.bin"
OTHER_RECORDING = DATA / "mimu4444_carlsson/exp_2/data.bin"
FLIGHT = sorted((DATA / "ansfl_quadrotor_4xDOT/StraightLine/RAW").glob("*_1114*.csv"))
OTHER_FLIGHT = [DATA / f"ansfl_quadrotor_4xDOT/Horizontal/path_11/IMU_{number}.csv" for number in range(1, 5)]
DEVICES = ("DOT1", "DOT2", "DOT4", "DOT7")  # as the flight's files and, in this order, IMU_1 to IMU_4 of the other flight

FLIGHT_SYSTEM = """
name: four Xsens DOT on a quadrotor
domain: 1
unit: {id: 1}
source: {kind: log, file: named by the command, calibration: cluster.yaml, rate_hz: 120, rest_s: 0}
lanes:
  - name: a
    detector: {method: accumulating, instruments: true}
    integrator: {algorithm: previous}
voters:
  - name: voter-1
"""


class SimulatedLog(ProcessTest):
    def simulate(self, *arguments):
        result = self.run_program(
            "quorient", "simulate", "coning", "--layout", "cone-4", "--interval", 0.005, "--duration", 12,
            "--quantum", 0.4848e-6, "--quantize", "carry", *arguments,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.write("log.csv", result.stdout)

    def replay(self, log, *arguments):
        result = self.replayed(log, "--set", "expect=null", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def replayed(self, log, *arguments):
        return self.run_program("quorient", "replay", log, "--system", CONFIGURATIONS / "demo.yaml", "--json", *arguments)

    def test_gives_the_same_bytes_on_every_run(self):
        log = self.simulate()
        fault = ("--fault", "axis=2,kind=bias,value=0.02,start=4")
        self.assertEqual(self.replay(log, *fault), self.replay(log, *fault))

    def test_tells_when_each_lane_detected_and_isolated_the_fault(self):
        report = exact_json.loads(self.replay(self.simulate(), "--fault", "axis=2,kind=bias,value=0.02,start=4"))
        self.assertEqual(report["frames"], 2400)
        self.assertEqual(report["faults"][0]["axes"], [2])
        for name, lane in report["faults"][0]["lanes"].items():
            self.assertEqual(lane["isolated"], [2], name)
            self.assertLessEqual(lane["detected_s"], 4.01, name)
            self.assertLessEqual(lane["isolated_s"], 4.02, name)
        self.assertEqual(report["false_isolations"], [])
        self.assertLess(report["attitude"]["final_error_rad"], 3e-6)

    def test_draws_the_same_picture_on_every_run_and_overwrites_none_unasked(self):
        log, picture = self.simulate(), self.run_directory / "run.svg"
        fault = ("--fault", "axis=2,kind=bias,value=0.02,start=4")
        self.replay(log, *fault, "--plot", picture)
        drawn = picture.read_text()
        for text in ("Attitude error against the truth", "G3, lane a", "G3, lane b", "residual of G3", ">isolated<", ">FULL<"):
            self.assertIn(text, drawn)
        refused = self.run_program("quorient", "replay", log, "--system", CONFIGURATIONS / "demo.yaml", "--plot", picture)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("exists already", refused.stderr)
        self.replay(log, *fault, "--plot", picture, "--force")
        self.assertEqual(picture.read_text(), drawn)
        self.replay(log, "--plot", picture, "--force")
        self.assertIn("Axes left out: none", picture.read_text())

    def test_blames_nobody_without_a_fault(self):
        report = exact_json.loads(self.replay(self.simulate()))
        self.assertEqual(report["faults"], [])
        self.assertEqual(report["isolations"], [])
        self.assertLess(report["attitude"]["max_error_rad"], 3e-6)

    def test_calls_an_isolation_false_against_a_truth_alone(self):
        log = self.simulate("--fault", "axis=0,kind=scale,value=0.5,start=2")
        report = exact_json.loads(self.replay(log))
        # Lane c's modulus predictor may call it ambiguous.
        self.assertLessEqual({"a", "b"}, {entry["lane"] for entry in report["isolations"] if entry["axes"] == [0]})
        self.assertEqual(report["false_isolations"], [], "the log was not said to be without faults")
        report = exact_json.loads(self.replay(log, "--fault", "axis=2,kind=bias,value=0.02,start=9"))
        self.assertLessEqual({"a", "b"}, {entry["lane"] for entry in report["false_isolations"] if entry["axes"] == [0]})

    def test_ends_with_1_where_the_files_expectations_are_not_met(self):
        healthy = self.simulate()
        self.assertEqual(self.replayed(healthy).returncode, 0, "the file's expectations belong to the faults that it injects")
        result = self.replayed(healthy, "--set", "expect={isolated: [2]}")
        self.assertEqual(result.returncode, 1)
        self.assertIn("not as expected: lane a isolated no axis", result.stderr)
        self.assertTrue(json.loads(result.stdout)["unmet"])
        met = self.replayed(healthy, "--set", "expect={isolated: []}")
        self.assertEqual((met.returncode, met.stderr), (0, ""))
        self.assertEqual(json.loads(met.stdout)["unmet"], [])

    def test_expects_a_fault_that_only_the_log_knows(self):
        log = self.simulate("--fault", "axis=2,kind=bias,value=0.02,start=4")
        self.assertEqual(self.replayed(log, "--set", "expect={isolated: [2]}").returncode, 0)
        self.assertEqual(self.replayed(log, "--set", "expect={isolated: [1]}").returncode, 1)

    def test_writes_every_verdict_and_every_event(self):
        log = self.simulate("--fault", "axis=2,kind=bias,value=0.02,start=4")
        verdicts, events = (self.write(name, "") for name in ("verdicts.csv", "events.jsonl"))
        report = json.loads(self.replay(log, "--verdicts", verdicts, "--events", events, "--force"))
        with open(verdicts, newline="") as file:
            rows = list(csv.DictReader(file))
        lanes = {row["lane"] for row in rows}
        self.assertEqual(lanes, set(report["undecided_s"]))
        self.assertEqual(len(rows), len(lanes) * report["frames"])
        first = next(row for row in rows if row["lane"] == "a" and row["isolated"] == "2")
        isolated_s = next(entry["time_s"] for entry in report["isolations"] if entry["lane"] == "a")
        self.assertAlmostEqual(float(first["time_s"]), isolated_s)
        self.assertTrue(all(row["isolated"] == "" for row in rows if float(row["time_s"]) < 4))
        found = [json.loads(line) for line in pathlib.Path(events).read_text().splitlines()]
        isolated = [event for event in found if event["code"] == "ISOLATED" and event["axes"] == [2]]
        self.assertTrue(isolated)
        self.assertAlmostEqual(isolated[0]["time_s"], 4, delta=0.1)

    def test_lists_the_spells_in_which_nobody_was_blamed_for_good(self):
        log = self.simulate("--fault", "axis=2,kind=bias,value=0.02,start=4")
        report = json.loads(self.replay(log))
        self.assertTrue(report["undecided"])
        for spell in report["undecided"]:
            self.assertGreaterEqual(spell["from_s"], 4)
        self.assertEqual({spell["lane"] for spell in report["undecided"]}, {lane for lane, states in report["undecided_s"].items() if states})
        self.assertEqual(json.loads(self.replay(self.simulate()))["undecided"], [])

    def test_replays_raw_counts_with_their_scale(self):
        rows = [f"{10 * i},{i % 5},{i % 7},{i % 3},{i % 5},{i % 7},{i % 3},{i % 5},{i % 7},{i % 3}" for i in range(1000)]
        log = self.write("counts.csv", "time_ms,g0x,g0y,g0z,g1x,g1y,g1z,g2x,g2y,g2z\n" + "\n".join(rows) + "\n")
        system = self.write("three.yaml", "name: three\nunit: {id: 1}\nsource: {kind: log, file: named by the command}\n"
                                          "lanes: [{name: a, detector: {method: field}}]\nvoters: [{name: voter-1}]\n")
        command = ("quorient", "replay", log, "--system", system, "--json")
        refused = self.run_program(*command)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--lsb-per-deg-s", refused.stderr)
        result = self.run_program(*command, "--lsb-per-deg-s", 16.4)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("rate_hz", json.loads(result.stdout)["log"])
        doubted = self.run_program(*command, "--lsb-per-deg-s", 16.4, "--set", "source.rate_hz=50")
        self.assertIn("source.rate_hz is 50, and the log has 100 frames a second", json.loads(doubted.stdout)["log"])

    def test_refuses_a_log_that_is_not_there(self):
        result = self.run_program("quorient", "replay", "nosuch.csv", "--system", CONFIGURATIONS / "demo.yaml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("nosuch.csv", result.stderr)


@unittest.skipUnless(RECORDING.exists(), f"no recording at {RECORDING}")
class Recording(ProcessTest):
    def test_gives_the_same_bytes_on_every_run(self):
        command = ("quorient", "replay", RECORDING, "--system", CONFIGURATIONS / "mimu4444.yaml", "--to", 30, "--json")
        fault = ("--fault", "axis=7,kind=bias,value=1,start=14")
        self.assertEqual(self.run_program(*command, *fault).stdout, self.run_program(*command, *fault).stdout)

    def replay_all(self, *arguments):
        """The whole recording, violent part included, calibrated by the other one."""
        cluster = self.write("cluster.yaml", "")
        calibrated = self.run_program("quorient", "calibrate", OTHER_RECORDING, "--out", cluster, "--force")
        self.assertEqual(calibrated.returncode, 0, calibrated.stderr)
        result = self.run_program(
            "quorient", "replay", RECORDING, "--system", CONFIGURATIONS / "mimu4444.yaml", "--set", "source.to_s=null",
            "--set", f"source.calibration={cluster}", "--set", "source.rest_s=0", "--set", "expect=null", "--json", *arguments,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        return exact_json.loads(result.stdout)

    def test_blames_nobody_over_the_whole_recording(self):
        report = self.replay_all()
        self.assertGreater(report["frames"], 37000)
        self.assertEqual(report["isolations"], [])


    def test_names_the_instrument_of_a_fault_in_violent_motion(self):
        report = self.replay_all("--fault", "axis=7,kind=bias,value=0.4,start=540", "--to", 560)
        self.assertEqual(report["false_isolations"], [])
        for name, lane in report["faults"][0]["lanes"].items():
            self.assertEqual(lane["isolated"], [6, 7, 8], name)
            self.assertLess(lane["isolated_s"], 542, name)


@unittest.skipUnless(len(FLIGHT) == 4 and OTHER_FLIGHT[0].exists(), "no flights of four DOTs in the data folder")
class Flight(ProcessTest):
    """Four files with clocks of their own; DOT7 has a sample of infinity and NaN at line 3909 and irregular steps around it. Calibrated by
    another flight of the same four devices, which calls them IMU_1 to IMU_4."""

    @classmethod
    def setUpClass(cls):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="quorient-test-"))
        cls.addClassCleanup(shutil.rmtree, folder, ignore_errors=True)
        command = [BIN / "quorient", "calibrate", *OTHER_FLIGHT, "--out", folder / "cluster.yaml"]
        subprocess.run(list(map(str, command)), check=True, capture_output=True, timeout=120)
        cls.calibration = (folder / "cluster.yaml").read_text()
        for number, device in enumerate(DEVICES):
            cls.calibration = cls.calibration.replace(f'"IMU_{number + 1}"', f'"{device}"')

    def cluster_of(self, devices):
        """The calibration of these devices alone."""
        head, axes = self.calibration.split("axes:\n")
        entries = ["  - {" + entry for entry in axes.split("  - {")[1:]]
        kept = [entry for entry in entries if any(f'instrument: "{device}"' in entry for device in devices)]
        self.assertEqual(len(kept), 3 * len(devices))
        return self.write("cluster.yaml", head + "axes:\n" + "".join(kept))

    def replay(self, devices, *arguments):
        self.cluster_of(devices)
        files = [file for file in FLIGHT if any(f"Xsens {device}_" in file.name for device in devices)]
        system = self.write("flight.yaml", FLIGHT_SYSTEM)
        result = self.run_program("quorient", "replay", *files, "--system", system, "--json", *arguments, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        return exact_json.loads(result.stdout)

    def test_passes_over_what_is_corrupted_and_blames_nobody(self):
        report = self.replay(DEVICES)
        self.assertGreater(report["frames"], 22000)
        self.assertIn("1 not finite", report["log"])
        self.assertIn("1 irregular in time", report["log"])
        self.assertEqual(report["rejected"]["axes_and_frames"], 0, "nothing that is not finite or in order is even published")
        self.assertEqual(report["isolations"], [])
        self.assertAlmostEqual(math.hypot(*report["attitude"]["final"]), 1, places=9)

    def test_names_the_device_of_a_fault_in_flight(self):
        report = self.replay(DEVICES, "--fault", "axis=7,kind=bias,value=0.1,start=100", "--to", 110)
        self.assertEqual(report["false_isolations"], [])
        for name, lane in report["faults"][0]["lanes"].items():
            self.assertEqual(lane["isolated"], [6, 7, 8], name)
            self.assertLess(lane["isolated_s"], 101, name)

    def test_keeps_the_attitude_within_the_spread_of_the_healthy_units(self):
        healthy = [device for device in DEVICES if device != "DOT7"]
        for to_s in (60, 120, 190):  # DOT7's bad sample lies at 32 s
            with self.subTest(to_s=to_s):
                attitude = lambda devices: self.replay(devices, "--to", to_s)["attitude"]["final"]
                pairs = [attitude(pair) for pair in itertools.combinations(healthy, 2)]
                spread = max(angle(a, b) for a, b in itertools.combinations(pairs, 2))
                self.assertLess(angle(attitude(DEVICES), attitude(healthy)), spread)


if __name__ == "__main__":
    unittest.main(verbosity=2)
