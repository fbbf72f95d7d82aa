"""The verbs that look at a running system and give it orders."""
import shutil
import signal
import subprocess
import time
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest


RUNNING = 3  # code of ServiceStatus.state (common/messages)


class LiveVerbs(ProcessTest):
    def setUp(self):
        super().setUp()
        self.pipeline = self.start(
            "quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--json",
            "--set", "source.duration_s=120", "--set", "source.faults=[]", "--set", "expect=null",
        )
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs")

    def echo(self, topic, count, *arguments):
        result = self.run_program("quorient", "echo", topic, "--count", count, "--json", "--timeout", 10, "--domain", self.domain, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [exact_json.loads(line) for line in result.stdout.splitlines()]

    def test_echo_shows_the_voted_stream_with_either_vendor(self):
        for vendor in ("cyclonedds", "fastdds"):
            samples = self.echo("voter_output", 20, "--dds", vendor)
            by_voter = {}
            for sample in samples:
                self.assertGreater(sample["output_sequence"], by_voter.get(sample["voter"], 0))
                by_voter[sample["voter"]] = sample["output_sequence"]
                self.assertAlmostEqual(sum(component**2 for component in sample["attitude"]), 1, places=12)

    def test_echo_of_the_owned_topic_comes_from_the_strongest_voter(self):
        self.assertEqual({sample["voter"] for sample in self.echo("voted", 70)[-5:]}, {1})

    def test_inject_breaks_an_axis_and_readmit_trusts_it_again(self):
        injected = self.run_program("quorient", "inject", "axis=G3,kind=bias,value=0.05,start=0", "--domain", self.domain)
        self.assertEqual(injected.returncode, 0, injected.stdout + injected.stderr)
        isolating = lambda: {verdict["detector"] for verdict in self.echo("verdict", 24) if verdict["isolated_mask"] == 0b100}  # noqa: E731
        self.eventually(lambda: len(isolating()) >= 2, "axis 2 isolated by two detectors")
        named = ("fdi-a", "fdi-b")  # lane c's modulus predictor may say AMBIGUOUS instead, and then has nothing to readmit
        refused = self.run_program("quorient", "readmit", "--axis", 2, "--domain", self.domain)
        self.assertEqual(refused.returncode, 1)
        for detector in named:
            self.assertIn(f"{detector}: does not readmit what still disagrees with the others: G3", refused.stdout, refused.stderr)
        self.assertEqual(self.run_program("quorient", "inject", "--clear", "--domain", self.domain).returncode, 0)
        readmitted = self.run_program("quorient", "readmit", "--axis", "G3", "--domain", self.domain)
        for detector in named:
            self.assertIn(f"{detector}: readmits G3", readmitted.stdout, readmitted.stderr)
        self.assertEqual(readmitted.returncode, 1 if "fdi-c: has not isolated" in readmitted.stdout else 0)
        self.eventually(lambda: self.echo("voter_output", 1)[0]["isolated_mask"] == 0, "axis 2 trusted again")

    def test_health_and_status_of_a_healthy_unit_read_without_pause_never_show_another_state(self):
        self.eventually(lambda: "GOOD" in self.run_program("quorient", "status", "--domain", self.domain).stdout, "the attitude is good")
        end_s = time.monotonic() + 4
        while time.monotonic() < end_s:
            for name in ("voter-1", "fdi-b", "sensor"):
                health = self.run_program("quorient", "health", name)
                self.assertEqual(health.returncode, 0, health.stdout + health.stderr)
        shown_file = self.run_directory / "shown.json"
        with open(shown_file, "w") as shown_states:
            watch = subprocess.Popen(self.command("quorient", "status", "--domain", self.domain, "--watch", "--seconds", 0.05, "--json"),
                                     env=self.environment, stdout=shown_states, stderr=subprocess.DEVNULL)
        self.processes.append(watch)
        time.sleep(4)  # about eight statuses of each service, each shown about ten times
        watch.terminate()
        watch.wait(timeout=10)
        shown = [exact_json.loads(line) for line in shown_file.read_text().splitlines()]
        self.assertGreater(len(shown), 40)
        for seconds in (0.1, 0.3, 0.6, 1):
            result = self.run_program("quorient", "status", "--domain", self.domain, "--seconds", seconds, "--json")
            shown.append(exact_json.loads(result.stdout))
        for state in shown:
            self.assertEqual(state["starving"], [])
            self.assertRegex(state["standing"]["text"], "^(GOOD|NOTHING)")
            self.assertLessEqual({service["state"] for service in state["services"]}, {RUNNING})

    def test_orders_for_axes_that_there_are_not_name_those_that_there_are(self):
        for order in (("inject", "axis=G9,kind=zero"), ("inject", "instrument=G9,kind=zero"), ("readmit", "--axis", "G9")):
            refused = self.run_program("quorient", *order, "--domain", self.domain)
            self.assertEqual(refused.returncode, 2, order)
            self.assertRegex(refused.stderr, "'?G9'?.*G1, G2, G3, G4", order)
        typo = self.run_program("quorient", "inject", "axis=G2,kind=tired", "--domain", self.domain)
        self.assertEqual(typo.returncode, 2)
        self.assertIn("fault 'axis=G2,kind=tired': unknown kind 'tired'", typo.stderr)

    def test_readmit_of_a_healthy_axis_is_refused(self):
        self.assertEqual(self.run_program("quorient", "readmit", "--axis", 0, "--domain", self.domain).returncode, 1)

    def test_a_second_launch_of_the_same_system_is_refused(self):
        again = self.run_program("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain)
        self.assertEqual(again.returncode, 2, again.stdout + again.stderr)
        self.assertRegex(again.stderr, r"(fdi|attitude|voter)-\w|sensor")
        for expected in ("already run", f"domain {self.domain}", "--join"):
            self.assertIn(expected, again.stderr)
        self.assertIsNone(self.pipeline.poll(), "the first one goes on")
        unknown = self.run_program("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--without", "sensors")
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("no such process; it has voter-1", unknown.stderr)

    def test_status_names_every_service_and_its_transport(self):
        result = self.run_program("quorient", "status", "--domain", self.domain, "--json")
        services = {service["name"]: service for service in exact_json.loads(result.stdout)["services"]}
        self.assertEqual(
            set(services), {"sensor", "voter-1", "voter-2"} | {f"{role}-{lane}" for role in ("fdi", "attitude") for lane in "abc"}
        )

    def test_status_that_is_watched_goes_on_until_it_is_interrupted(self):
        watching = self.start("quorient", "status", "--domain", self.domain, "--json", "--watch", "--seconds", 0.5)
        seen = [exact_json.loads(watching.stdout.readline()) for _ in range(6)]
        self.assertIn("attitude", seen[-1]["standing"]["text"])
        self.assertEqual(len(seen[-1]["services"]), 9)
        watching.send_signal(signal.SIGINT)
        watching.communicate(timeout=10)
        self.assertEqual(watching.returncode, 0)

    def test_status_that_is_watched_ends_where_nobody_reads_it(self):
        watched = subprocess.Popen(self.command("quorient", "status", "--watch", "--seconds", 0.3, "--domain", self.domain), env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(watched.kill)
        self.assertTrue(watched.stdout.readline())
        watched.stdout.close()
        self.assertIn("standard output cannot be written", watched.stderr.read())
        self.assertEqual(watched.wait(20), 2)

    def test_sigterm_ends_everything_in_order_within_two_seconds(self):
        self.pipeline.send_signal(signal.SIGTERM)
        self.pipeline.wait(timeout=5)
        self.assertEqual(self.pipeline.returncode, 0)
        self.assertNotEqual(self.run_program("quorient", "health", "voter-1", "--fresh", 0.001).returncode, 0)

    @unittest.skipUnless(shutil.which("tshark"), "tshark is not installed")
    def test_tshark_names_topics_and_types(self):
        file = self.run_directory / "capture.pcapng"
        file.touch()
        file.chmod(0o666)  # the capture may run as another user
        ports = f"udp portrange {7400 + 250 * self.domain}-{7400 + 250 * self.domain + 80}"
        tshark = subprocess.Popen(["tshark", "-i", "lo", "-f", ports, "-w", file], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.processes.append(tshark)
        self.eventually(lambda: file.stat().st_size > 10_000 or tshark.poll() is not None, "the capture has begun")
        if tshark.poll() is not None:
            self.skipTest("capturing on loopback is not permitted")
        self.echo("voter_output", 5)  # discovery sends the names to a participant that joins
        tshark.send_signal(signal.SIGINT)
        tshark.communicate(timeout=60)
        decoded = subprocess.run(
            ["tshark", "-r", file, "-Y", "rtps.param.topicName", "-T", "fields", "-e", "rtps.param.topicName", "-e", "rtps.param.typeName"], capture_output=True, text=True, timeout=60
        )
        names = set(decoded.stdout.replace(",", "\t").split())
        for name in ("quorient/voter_output", "quorient_msgs::VoterOutput", "quorient/frame", "quorient_msgs::SensorFrame"):
            self.assertIn(name, names)


if __name__ == "__main__":
    unittest.main(verbosity=2)
