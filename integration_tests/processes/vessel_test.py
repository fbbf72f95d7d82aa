"""The unmanned vessel as processes: publisher, two detectors on two vendors, verdicts and events; and its twins."""
import subprocess
import unittest

from integration_tests.harness.processes import CONFIGURATIONS, ROOT, ProcessTest

VESSEL = CONFIGURATIONS / "vessel.yaml"
SPEED = 6  # 80 s of the scenario in 14 s


class VesselDemo(ProcessTest):
    def test_isolates_each_fault_in_its_window_in_both_lanes(self):
        code, summary, stderr = self.launch(VESSEL, "--speed", SPEED)
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        for fault, (axis, begin_s, end_s) in zip(summary["faults"], [(1, 20, 30), (0, 50, 70)], strict=True):
            self.assertEqual(fault["axis"], axis)
            self.assertAlmostEqual(fault["begin_s"], begin_s, delta=0.2)  # a frame may be skipped on a machine without time
            self.assertAlmostEqual(fault["end_s"], end_s, delta=0.2)
        self.assertEqual({lane["vendor"] for lane in summary["lanes"].values()}, {"fastdds", "cyclonedds"})
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["false_isolations"], [], name)
            for fault, reaction in zip(summary["faults"], lane["faults"]):
                self.assertGreaterEqual(reaction["isolated_s"], fault["begin_s"], name)
                self.assertLess(reaction["isolated_s"], fault["begin_s"] + 4, name)
                self.assertGreater(reaction["trusted_s"], fault["end_s"], name)
            self.assertLess(lane["faults"][0]["trusted_s"], 50, name)

    def test_raises_no_alarm_without_faults(self):
        code, summary, stderr = self.launch(VESSEL, "--speed", SPEED, "--set", "source.faults=[]")
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        self.assertEqual(summary["faults"], [])
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["false_isolations"], [], name)
            self.assertEqual(lane["suspicious"], 0, name)
            self.assertGreater(lane["verdicts"], 0.9 * summary["frames"], name)

    def test_fails_when_a_fault_is_not_found(self):
        fault = "axis=1,kind=bias,value=1.0e-5,start=2"
        code, summary, stderr = self.launch(VESSEL, "--speed", SPEED, "--set", f"source.faults=['{fault}']", "--set", "source.duration_s=10")
        self.assertEqual(code, 1)
        self.assertEqual(len(summary["unmet"]), 2, "each lane")
        self.assertIn("not isolated", stderr)

    def test_fails_when_the_verdict_never_clears_again(self):
        latched = "lanes=[{name: b, detector: {scheme: directional, poles: [[-3, -4], [-0.5, -4]]}}]"
        code, summary, stderr = self.launch(VESSEL, "--speed", SPEED, "--set", latched)
        self.assertEqual(code, 1, "with the gyro excluded the paper's scheme cannot detect the second fault")
        self.assertIsNotNone(summary["lanes"]["b"]["faults"][0]["isolated_s"])
        self.assertIsNone(summary["lanes"]["b"]["faults"][1]["isolated_s"])

    def test_starts_neither_integrators_nor_voters(self):
        self.launch(VESSEL, "--speed", SPEED, "--set", "source.duration_s=1", "--set", "expect=null")
        logs = {path.stem for path in self.run_directory.glob("*.log")}
        self.assertEqual(logs, {"sensor", "fdi-a", "fdi-b"})
        refused = self.run_program("quorient-attitude", VESSEL, "--name", "attitude-a")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("no integrators", refused.stderr)


class Rudder(ProcessTest):
    def test_that_is_not_told_makes_the_verdicts_blind_with_the_reason_and_names_nobody(self):
        result = self.run_program(
            "quorient", "launch", VESSEL, "--domain", self.domain, "--speed", SPEED, "--set", "source.duration_s=12", "--set", "source.faults=[]",
            "--set", "source.rudder={amplitude_rad: 0.01, period_s: 20, lost_from_s: 4, lost_to_s: 6}", timeout=60,
        )
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        for lane in ("fdi-a", "fdi-b"):
            self.assertRegex(result.stdout, rf"4\.\d+ s  {lane} +BLIND: the known input is missing")
        self.assertIn("isolated without a fault: nothing", result.stdout)

    def test_that_is_lost_while_the_gyro_is_faulty_blames_nobody_else(self):
        code, summary, stderr = self.launch(
            VESSEL, "--speed", SPEED, "--set", "source.rudder={amplitude_rad: 0.01, period_s: 20, lost_from_s: 25, lost_to_s: 26}",
            "--set", "source.duration_s=48", "--set", "source.faults=['axis=1,kind=bias,value=0.01,start=20,end=30']",
        )
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        for name, lane in summary["lanes"].items():
            self.assertGreaterEqual(lane["suspicious"], 90, name)
            self.assertEqual(lane["false_isolations"], [], name)


class SystemFile(ProcessTest):
    needs_quiet_machine = False

    def refused(self, text, *arguments):
        result = self.run_program("quorient", "launch", self.write("vessel.yaml", text), *arguments, timeout=20)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(list(self.run_directory.glob("*.log")), [], "something was started")
        return result.stderr

    def test_reports_what_cannot_be_observed_with_its_place(self):
        text = VESSEL.read_text().replace("[[-3, -4]]", "[[-3, 4]]").replace("period_s: 20", "period_s: 0")
        errors = self.refused(text)
        self.assertRegex(errors, r"vessel\.yaml:\d+:\d+: lanes\[0\]\.detector: .*pole 4 is not in the left half plane")
        self.assertRegex(errors, r"vessel\.yaml:\d+:\d+: source\.rudder\.period_s")
        self.assertIn("2 problems, nothing started", errors)

    def test_refuses_a_plant_that_the_other_sensor_cannot_see(self):
        errors = self.refused(
            VESSEL.read_text(), "--set", "unit.vessel=null", "--set", "unit.plant={A: [[0.5, 0], [0, -2]], B: [[1], [1]]}"
        )
        self.assertIn("do not see the plant's pole 0.5", errors)


class Demo(ProcessTest):
    def test_knows_the_vessel(self):
        text = subprocess.run([ROOT / "deploy/demo", "--help"], capture_output=True, text=True, timeout=20, check=True).stdout
        self.assertIn("--vessel", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
