"""The demos as a user starts them, and their twins without the fault."""
import re
import unittest
import xml.etree.ElementTree

from integration_tests.harness.processes import CONFIGURATIONS, DATA, ROOT, ProcessTest

RECORDING = DATA / "mimu4444_carlsson/exp_1/data.bin"
SOFT_FLIGHT = DATA / "field/cats_drone_soft_axis_1.csv"
SOUND_FLIGHT = DATA / "field/cats_drone_healthy.csv"

TRUE_GAIN_OF_G0_Z = (0.44, 0.47)  # of SOFT_FLIGHT, whole flight against g1 and g2


def words_of(picture, kind):
    """The texts of one class of a picture: t its titles, o what stands in its bars."""
    return [text.text for text in xml.etree.ElementTree.parse(picture).iter("{http://www.w3.org/2000/svg}text") if text.get("class") == kind]


class DefaultDemo(ProcessTest):
    def test_isolates_axis_1_in_every_lane_and_keeps_the_attitude(self):
        picture = self.run_directory / "run.svg"
        code, summary, stderr = self.launch(CONFIGURATIONS / "demo.yaml", "--plot", picture)
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        self.check_picture(picture)
        self.assertEqual(summary["fault"]["axes"], [1])
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["isolated"], [1], name)
            self.assertLessEqual(lane["frames_to_isolation"], 3, name)
            self.assertEqual(lane["working"], [0, 2, 3], name)
        self.assertEqual({lane["vendor"] for lane in summary["lanes"].values()}, {"fastdds", "cyclonedds"})
        self.assertEqual(summary["voted"]["missing"], 0)
        self.assertEqual(summary["voted"]["disordered"], 0)
        self.assertGreater(summary["voted"]["attitude"]["compared"], 3900)
        self.assertLess(summary["voted"]["attitude"]["final_error_rad"], 3e-6)
        # The fault is really there: without roll-back each frame up to its isolation leaves 6.9e-5 rad, and there is at least one.
        self.assertGreater(summary["without_rollback"]["final_error_rad"], 6e-5)

    def check_picture(self, picture):
        """As the README shows it: the same diagrams, and one lane's bar for each isolation."""
        self.assertEqual(words_of(picture, "t"), words_of(ROOT / "docs/run.svg", "t"))
        for drawn in (picture, ROOT / "docs/run.svg"):
            self.assertEqual(words_of(drawn, "o").count("isolated"), 3)
            self.assertLess(drawn.stat().st_size, 60_000)

    def test_isolates_nothing_without_the_fault(self):
        code, summary, stderr = self.launch(
            CONFIGURATIONS / "demo.yaml", "--set", "source.faults=[]", "--set", "source.duration_s=8", "--set", "expect={isolated: [], no_gap: true}"
        )
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        self.assertIsNone(summary["fault"])
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["isolated"], [], name)
        self.assertLess(summary["voted"]["attitude"]["max_error_rad"], 3e-6)

    def test_fails_when_the_expected_axis_is_another(self):
        code, summary, stderr = self.launch(
            CONFIGURATIONS / "demo.yaml",
            "--set", "source.duration_s=4",
            "--set", "source.faults=['axis=2,kind=scale,value=0.8,start=1']",
        )
        self.assertEqual(code, 1)
        self.assertTrue(summary["unmet"])
        self.assertIn("not as expected", stderr)


class TwoFaultsDemo(ProcessTest):
    def test_names_both_faulty_axes_by_three_dissimilar_methods(self):
        code, summary, stderr = self.launch(CONFIGURATIONS / "two-faults.yaml")
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["isolated"], [1, 4], name)

    def test_names_nobody_without_the_faults(self):
        code, summary, stderr = self.launch(
            CONFIGURATIONS / "two-faults.yaml", "--set", "source.faults=[]", "--set", "source.duration_s=6", "--set", "expect={isolated: [], no_gap: true}"
        )
        self.assertEqual(code, 0, f"{summary}\n{stderr}")


@unittest.skipUnless(RECORDING.exists(), f"no recording at {RECORDING}")
class RecordingDemo(ProcessTest):
    def test_names_imu3_in_every_lane(self):
        code, summary, stderr = self.launch(CONFIGURATIONS / "mimu4444.yaml", "--log", RECORDING, "--speed", 2)
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["isolated"], [6, 7, 8], name)
        self.assertEqual(summary["voted"]["missing"], 0)

    def test_names_nobody_without_the_added_fault(self):
        code, summary, stderr = self.launch(
            CONFIGURATIONS / "mimu4444.yaml", "--log", RECORDING, "--speed", 4, "--set", "source.faults=[]", "--set", "expect={isolated: [], no_gap: true}"
        )
        self.assertEqual(code, 0, f"{summary}\n{stderr}")


@unittest.skipUnless(SOFT_FLIGHT.exists(), f"no recording at {SOFT_FLIGHT}")
class FlightDemo(ProcessTest):
    """deploy/demo --log FILE on flights of three gyros, as they are."""

    def fly(self, log):
        code, summary, stderr = self.launch(CONFIGURATIONS / "flight.yaml", "--log", log, "--speed", 4)
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        self.assertEqual(len(summary["lanes"]), 3)
        self.assertEqual(summary["voted"]["missing"], 0)
        self.assertEqual(summary["voted"]["disordered"], 0)
        return summary

    def test_names_the_gyro_with_the_soft_axis_in_every_lane_and_goes_on_with_the_other_two(self):
        summary = self.fly(SOFT_FLIGHT)
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["isolated"], [0, 1, 2], name)
            self.assertEqual(lane["working"], [3, 4, 5, 6, 7, 8], name)
            gain = float(re.search(r"g0 z: gain (\S+) ", lane["diagnosis"])[1])
            self.assertTrue(TRUE_GAIN_OF_G0_Z[0] - 0.03 <= gain <= TRUE_GAIN_OF_G0_Z[1] + 0.03, f"{name}: {gain}")

    def test_names_nobody_on_a_sound_flight(self):
        for name, lane in self.fly(SOUND_FLIGHT)["lanes"].items():
            self.assertEqual(lane["isolated"], [], name)
            self.assertEqual(lane["diagnosis"], "", name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
