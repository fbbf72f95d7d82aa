"""Input that must not hurt: each a clear error before anything starts, or a counted rejection."""
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.processes import CONFIGURATIONS, DATA, ProcessTest

RECORDING = DATA / "mimu4444_carlsson/exp_1/data.bin"
DEMO = (CONFIGURATIONS / "demo.yaml").read_text()


class SystemFile(ProcessTest):
    def refused(self, text, *arguments):
        path = self.write("system.yaml", text)
        result = self.run_program("quorient", "launch", path, *arguments, timeout=20)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(list(self.run_directory.glob("*.log")), [], "something was started")
        return result.stderr

    def test_reports_every_mistake_at_once_with_its_place(self):
        text = DEMO.replace("layout: cone-4", "layuot: cone-4").replace("rate_hz: 200", "rate_hz: fast").replace("k2: 0.084", "k2: 0.084 rad/s")
        errors = self.refused(text)
        self.assertRegex(errors, r"system\.yaml:\d+:\d+: unknown key 'layuot' in unit; did you mean 'layout'\?")
        self.assertRegex(errors, r"system\.yaml:\d+:\d+: source\.rate_hz: expected a number \[Hz\], got 'fast'")
        self.assertRegex(errors, r"system\.yaml:\d+:\d+: source\.motion\.k2: expected a number \[rad/s\], got '0.084 rad/s'")
        self.assertRegex(errors, r"\d problems, nothing started")

    def test_refuses_a_key_that_stands_there_twice(self):
        errors = self.refused(DEMO.replace("domain: 42", "domain: 42\ndomain: 43"))
        self.assertRegex(errors, r"system\.yaml:\d+:1: domain: stands here a second time, first in line \d+")

    def test_refuses_a_tab_in_plain_words(self):
        self.assertRegex(self.refused(DEMO.replace("  id: 1", "\tid: 1")), r"system\.yaml:\d+:1: a tab indents this line")

    def test_refuses_names_that_are_taken(self):
        self.assertRegex(self.refused(DEMO.replace("name: voter-2", "name: voter-1")), r"voters\[1\]\.name: 'voter-1' is taken")
        self.assertRegex(self.refused(DEMO.replace("name: voter-2", "name: fdi-a")), r"voters\[1\]\.name: 'fdi-a' is taken by the detector")

    def test_refuses_a_directory(self):
        result = self.run_program("quorient", "launch", self.run_directory, timeout=20)
        self.assertEqual(result.returncode, 2)
        self.assertIn("is a directory, expected a file", result.stderr)

    def test_is_judged_by_check_as_by_a_start_and_starts_nothing(self):
        wrong = self.write("wrong.yaml", DEMO.replace("rate_hz: 200", "rate_hz: fast"))
        started = self.run_program("quorient", "launch", wrong, timeout=20)
        checked = self.run_program("quorient", "check", wrong, timeout=20)
        self.assertEqual((checked.returncode, checked.stdout, checked.stderr), (2, "", started.stderr))
        right = self.run_program("quorient", "check", CONFIGURATIONS / "demo.yaml", timeout=20)
        self.assertEqual((right.returncode, right.stderr), (0, ""))
        effective = self.run_program("quorient", "check", self.write("effective.yaml", right.stdout), timeout=20)
        self.assertEqual((effective.returncode, effective.stdout), (0, right.stdout))
        self.assertEqual(list(self.run_directory.glob("*.heartbeat")) + list(self.run_directory.glob("*.log")), [], "something was started")

    def test_refuses_an_unknown_vendor(self):
        self.assertIn("opendds", self.refused(DEMO.replace("dds: fastdds", "dds: opendds", 1)))

    def test_refuses_an_impossible_domain(self):
        self.assertIn("231", self.refused(DEMO.replace("domain: 42", "domain: 231")))

    def test_refuses_an_interface_that_is_not_here(self):
        self.assertIn("nosuch0", self.refused(DEMO.replace("interface: lo", "interface: nosuch0")))

    def test_refuses_an_axis_far_from_a_unit_vector(self):
        axes = "axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.6, 0.6, 0.6]]"
        self.assertRegex(self.refused(DEMO.replace("layout: cone-4", axes)), r"unit\.axes.*axis 3")

    def test_refuses_four_coplanar_axes(self):
        axes = "axes: [[1, 0, 0], [0, 1, 0], [0.6, 0.8, 0], [0.8, -0.6, 0]]"
        self.assertRegex(self.refused(DEMO.replace("layout: cone-4", axes)), r"unit\.axes.*plane")

    def test_refuses_a_method_that_four_axes_do_not_carry(self):
        self.assertRegex(self.refused(DEMO.replace("method: extrapolation", "method: invariants, tolerance: 1.0e-5")), r"lanes\[2\]")

    def test_refuses_to_level_a_simulation_that_has_no_accelerometers(self):
        unit = DEMO.replace("  layout: cone-4\n", "  layout: cone-4\n  initial_attitude: {heading_deg: 30%s}\n")
        self.assertIn("no accelerometers", self.refused(unit % ""))
        self.assertRegex(self.refused(unit % ", specific_force_m_s2: [0, 0, 14]"), r"specific_force_m_s2.*must be at rest")

    def test_refuses_a_fault_of_an_unknown_kind(self):
        self.assertIn("kind", self.refused(DEMO.replace("kind=scale", "kind=soft")))

    def test_accepts_the_same_file_without_the_mistakes(self):
        path = self.write("system.yaml", DEMO)
        code, summary, stderr = self.launch(path, "--set", "source.duration_s=1", "--set", "expect=null", timeout=60)
        self.assertEqual(code, 0, stderr)
        self.assertGreater(summary["frames"], 150)


@unittest.skipUnless(RECORDING.exists(), f"no recording at {RECORDING}")
class DamagedRecording(ProcessTest):
    """One second of the recording, damaged; the pipeline plays what is intact."""

    PACKET = 106
    ACKNOWLEDGE = 4

    def play(self, content):
        path = self.run_directory / "data.bin"
        path.write_bytes(content)
        code, summary, stderr = self.launch(
            CONFIGURATIONS / "mimu4444.yaml", "--log", path, "--speed", 4,
            "--set", "source.faults=[]", "--set", "source.rest_s=3", "--set", "expect={isolated: []}",
        )
        self.assertEqual(code, 0, stderr)
        return summary

    def content(self, packets):
        with RECORDING.open("rb") as file:
            return bytearray(file.read(self.ACKNOWLEDGE + packets * self.PACKET))

    def test_cut_in_the_middle_of_a_packet_ends_there(self):
        summary = self.play(self.content(400)[: -self.PACKET // 2])
        self.assertEqual(summary["frames"], 399)

    def test_with_a_broken_checksum_loses_that_packet_alone(self):
        content = self.content(400)
        content[self.ACKNOWLEDGE + 300 * self.PACKET + 50] ^= 0xFF
        summary = self.play(content)
        self.assertEqual(summary["frames"], 399)


class ForeignPublisher(ProcessTest):
    def test_of_the_same_unit_is_counted_and_ignored(self):
        configuration = CONFIGURATIONS / "demo.yaml"
        pipeline = self.start(
            "quorient", "launch", configuration, "--domain", self.domain, "--json",
            "--set", "source.duration_s=8", "--set", "source.faults=[]", "--set", "expect={isolated: [], no_gap: true}",
        )
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs")
        # A second publisher of the same unit, with a motion of its own.
        foreign = self.start(
            "quorient-sensor", configuration, "--domain", self.domain, "--set", "source.motion={kind: turn}", "--set", "sensor.wait_s=0",
            "--set", "source.faults=[]",
        )
        status = {}

        def counted():
            result = self.run_program("quorient", "status", "--domain", self.domain, "--json", "--seconds", 1.5)
            status.update(exact_json.loads(result.stdout))
            detectors = [service for service in status["services"] if service["name"].startswith("fdi-")]
            return len(detectors) == 3 and all(service["foreign"] > 0 for service in detectors)

        self.eventually(counted, "every detector counts the foreign publisher")
        foreign.terminate()
        foreign.wait(10)
        output, _ = pipeline.communicate(timeout=60)
        summary = exact_json.loads(output.splitlines()[-1])
        self.assertLess(summary["voted"]["attitude"]["max_error_rad"], 3e-6)
        for lane in summary["lanes"].values():
            self.assertEqual(lane["isolated"], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
