#!/usr/bin/env python3
"""quorient replay: the whole system offline, the same bytes on every run."""
import json
import unittest

from harness import CONFIGURATIONS, DATA, ProcessTest

RECORDING = DATA / "mimu4444_carlsson/exp_1/data.bin"
OTHER_RECORDING = DATA / "mimu4444_carlsson/exp_2/data.bin"


class SimulatedLog(ProcessTest):
    def simulate(self, *arguments):
        result = self.run_program(
            "quorient", "simulate", "coning", "--layout", "cone-4", "--interval", 0.005, "--duration", 12,
            "--quantum", 0.4848e-6, "--quantize", "carry", *arguments,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.write("log.csv", result.stdout)

    def replay(self, log, *arguments):
        result = self.run_program("quorient", "replay", log, "--system", CONFIGURATIONS / "demo.yaml", "--json", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_gives_the_same_bytes_on_every_run(self):
        log = self.simulate()
        fault = ("--fault", "axis=2,kind=bias,value=0.02,start=4")
        self.assertEqual(self.replay(log, *fault), self.replay(log, *fault))

    def test_tells_when_each_lane_detected_and_isolated_the_fault(self):
        report = json.loads(self.replay(self.simulate(), "--fault", "axis=2,kind=bias,value=0.02,start=4"))
        self.assertEqual(report["frames"], 2400)
        self.assertEqual(report["faults"][0]["axes"], [2])
        for name, lane in report["faults"][0]["lanes"].items():
            self.assertEqual(lane["isolated"], [2], name)
            self.assertLessEqual(lane["detected_s"], 4.01, name)
            self.assertLessEqual(lane["isolated_s"], 4.02, name)
        self.assertEqual(report["false_isolations"], [])
        self.assertLess(report["attitude"]["final_error_rad"], 3e-6)

    def test_blames_nobody_without_a_fault(self):
        report = json.loads(self.replay(self.simulate()))
        self.assertEqual(report["faults"], [])
        self.assertEqual(report["false_isolations"], [])
        self.assertLess(report["attitude"]["max_error_rad"], 3e-6)

    def test_calls_a_fault_false_that_nobody_announced(self):
        log = self.simulate("--fault", "axis=0,kind=scale,value=0.5,start=2")
        report = json.loads(self.replay(log))
        # Lane c's modulus predictor may call it ambiguous.
        self.assertLessEqual({"a", "b"}, {entry["lane"] for entry in report["false_isolations"]})

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
        calibrated = self.run_program("quorient", "calibrate", OTHER_RECORDING, "--out", cluster)
        self.assertEqual(calibrated.returncode, 0, calibrated.stderr)
        result = self.run_program(
            "quorient", "replay", RECORDING, "--system", CONFIGURATIONS / "mimu4444.yaml", "--set", "source.to_s=null",
            "--set", f"source.calibration={cluster}", "--set", "source.rest_s=0", "--set", "expect=null", "--json", *arguments,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_blames_nobody_over_the_whole_recording(self):
        report = self.replay_all()
        self.assertGreater(report["frames"], 37000)
        self.assertEqual(report["false_isolations"], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
