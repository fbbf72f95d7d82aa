"""Several processes of a system file in one: the same output, the same topics for all processes outside, and one death for all of them."""
import json
import os
import signal
import unittest

from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest, children_of, words_of

LANE = "compose=[[fdi-a, attitude-a]]"
# One vendor, so that everything can share a process.
ALL_BUT_SENSOR = ["fdi-a", "attitude-a", "fdi-b", "attitude-b", "fdi-c", "attitude-c", "voter-1", "voter-2"]


def settings(*assignments):
    return [word for assignment in assignments for word in ("--set", assignment)]


def one_vendor(vendor):
    return settings(f"dds={vendor}", f"lanes.b.dds={vendor}", f"voters.voter-2.dds={vendor}")


class Composition(ProcessTest):
    def demo(self, *arguments):
        return self.launch(CONFIGURATIONS / "demo.yaml", "--set", "source.duration_s=12", *arguments)

    def expect_right(self, code, summary, stderr):
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        self.assertEqual(len(summary["lanes"]), 3)
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["isolated"], [1], name)
            self.assertLessEqual(lane["frames_to_isolation"], 3, name)
        self.assertEqual(summary["voted"]["missing"], 0)
        self.assertEqual(summary["voted"]["disordered"], 0)
        self.assertGreater(summary["voted"]["attitude"]["compared"], 2000)
        self.assertLess(summary["voted"]["attitude"]["final_error_rad"], 3e-6)
        # The fault is really there.
        self.assertGreater(summary["without_rollback"]["final_error_rad"], 6e-5)

    def test_of_one_lane_isolates_and_keeps_the_attitude(self):
        self.expect_right(*self.demo(*settings(LANE)))

    def test_of_a_lane_of_each_vendor_and_the_voters_beside_them_isolates_and_keeps_the_attitude(self):
        self.expect_right(*self.demo(*settings("compose=[[fdi-a, attitude-a, voter-1], [voter-2, attitude-b, fdi-b]]")))

    def test_of_all_but_the_sensor_isolates_and_keeps_the_attitude_on_either_vendor(self):
        for vendor in ("cyclonedds", "fastdds"):
            with self.subTest(vendor):
                self.expect_right(*self.demo(*one_vendor(vendor), *settings(f"compose=[{ALL_BUT_SENSOR}]")))

    def test_of_everything_isolates_nothing_without_the_fault(self):
        code, summary, stderr = self.launch(
            CONFIGURATIONS / "demo.yaml", *one_vendor("cyclonedds"),
            *settings(f"compose=[{['sensor', *ALL_BUT_SENSOR]}]", "source.faults=[]", "source.duration_s=6", "expect={isolated: [], no_gap: true}"))
        self.assertEqual(code, 0, f"{summary}\n{stderr}")
        self.assertLess(summary["voted"]["attitude"]["max_error_rad"], 3e-6)

    def test_counts_no_sample_twice(self):
        """Every service's own count of duplicates, by the status that it sends to processes outside."""
        launch = self.start("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--json", *settings(
            "compose=[[fdi-a, attitude-a, voter-1]]", "source.duration_s=60", "expect=null"))
        self.eventually(lambda: self.frames_of("attitude-a") > 400, "the lane handles frames")
        echo = self.run_program("quorient", "echo", "status", "--count", 40, "--json", "--timeout", 20, "--domain", self.domain, timeout=40)
        statuses = {status["name"]: status for status in map(json.loads, echo.stdout.splitlines())}
        self.assertLessEqual({"fdi-a", "attitude-a", "voter-1", "fdi-b"}, set(statuses), echo.stderr)
        for name, status in statuses.items():
            self.assertEqual(status["duplicates"], 0, name)
        processes = {name: status["process"] for name, status in statuses.items()}
        self.assertEqual(processes["fdi-a"], processes["attitude-a"])
        self.assertNotEqual(processes["fdi-a"], processes["fdi-b"])
        self.assertIsNone(launch.poll())

    def test_exchanges_verdicts_and_attitudes_of_its_lane_alone(self):
        """A status counts the readers of a service's samples: its own lane's other half is one of the first lane's alone."""
        self.start("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, *one_vendor("cyclonedds"),
                   *settings(LANE, "source.duration_s=60", "source.faults=[]", "expect=null"))
        self.eventually(lambda: self.frames_of("attitude-a") > 400, "the lane handles frames")
        readers = self.readers()
        self.assertGreaterEqual(readers["fdi-b"], 4, "two integrators and two voters")
        self.assertEqual(readers["fdi-a"], readers["fdi-b"] + 1)
        self.assertGreaterEqual(readers["attitude-b"], 4, "two detectors and two voters")
        self.assertEqual(readers["attitude-a"], readers["attitude-b"] + 1)

    def test_separate_processes_exchange_them_with_everybody(self):
        self.start("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, *one_vendor("cyclonedds"),
                   *settings("source.duration_s=60", "source.faults=[]", "expect=null"))
        self.eventually(lambda: self.frames_of("attitude-a") > 400, "the lane handles frames")
        readers = self.readers()
        self.assertEqual(readers["fdi-a"], readers["fdi-b"])
        self.assertEqual(readers["attitude-a"], readers["attitude-b"])

    def readers(self):
        echo = self.run_program("quorient", "echo", "status", "--count", 40, "--json", "--timeout", 20, "--domain", self.domain, timeout=40)
        return {status["name"]: status["matched"] for status in map(json.loads, echo.stdout.splitlines())}

    def frames_of(self, name):
        beat = self.heartbeat(name)
        words = beat.read_text().split() if beat.exists() else []
        return int(words[1]) if len(words) > 1 else 0

    def test_that_dies_is_started_again_as_a_whole(self):
        self.start("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, *settings(LANE, "source.duration_s=60", "expect=null"))
        self.eventually(lambda: self.frames_of("attitude-a") > 200 and self.frames_of("fdi-a") > 200, "both handle frames")
        first = self.process_of("fdi-a")
        self.assertEqual(first, self.process_of("attitude-a"))
        os.kill(first, signal.SIGKILL)
        self.eventually(lambda: self.process_of("fdi-a") not in (None, first), "the composition is back")
        self.eventually(lambda: self.frames_of("attitude-a") > 200 and self.frames_of("fdi-a") > 200, "both handle frames again")
        self.assertEqual(self.process_of("fdi-a"), self.process_of("attitude-a"))

    def process_of(self, name):
        """The process that runs a service of this test's launch."""
        return next((child for child in children_of(self.processes[0].pid) if name in words_of(child)), None)

    def test_refuses_what_cannot_share_a_process(self):
        for names, why in ((("fdi-a", "fdi-b"), "has another `dds`"), (("fdi-a", "nobody"), "no process 'nobody'"), (("fdi-a", "fdi-a"), "twice")):
            result = self.run_program("quorient-run", CONFIGURATIONS / "demo.yaml", *names, "--domain", self.domain)
            self.assertEqual(result.returncode, 2, names)
            self.assertIn(why, result.stderr)
        result = self.run_program("quorient-run", CONFIGURATIONS / "demo.yaml", "--of", "fdi-a", "--domain", self.domain)
        self.assertEqual(result.returncode, 2)
        self.assertIn("no composition has a process 'fdi-a'", result.stderr)

    def test_is_refused_under_security(self):
        for program in (("quorient", "check", CONFIGURATIONS / "demo.yaml"), ("quorient-run", CONFIGURATIONS / "demo.yaml", "fdi-a", "attitude-a")):
            result = self.run_program(*program, *settings("security={level: sign, directory: nowhere}", LANE))
            self.assertEqual(result.returncode, 2)
            self.assertIn("a secured process runs alone", result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
