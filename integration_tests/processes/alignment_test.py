"""How an attitude begins, and begins again: levelled, stated by command, lost with its publisher."""
import math
import os
import re
import signal
import struct
import subprocess
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.processes import CONFIGURATIONS, DATA, ProcessTest
from integration_tests.harness.quaternion import angle, conjugate, product

RECORDING = DATA / "mimu4444_carlsson/exp_1/data.bin"
NORMAL, LOST = 2, 5  # AttitudeMode
FULL, LOST_LEVEL = 1, 5  # VoteLevel


def gravity_in_body(attitude):
    """The direction of R's z axis, seen from the body."""
    w, x, y, z = attitude
    return [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]


def specific_force_at_rest(file, seconds):
    """Mean of the eight accelerometer triads over the first seconds, in the body frame [g]: an independent reading of the packets."""
    content = file.read_bytes()
    begin = content.index(b"\xaa", 4)
    mean = [0.0, 0.0, 0.0]
    packets = int(seconds * 62.5)
    for packet in range(packets):
        words = struct.unpack_from(">48h", content, begin + 106 * packet + 8)
        for imu in range(8):
            x, y, z = words[6 * imu : 6 * imu + 3]
            body = (-y, -x, -z) if imu % 2 else (x, y, z)  # IMU2, IMU4, … are mounted flipped
            mean = [m + value / 2048 / 8 / packets for m, value in zip(mean, body)]
    return mean


class RunningUnit(ProcessTest):
    def echo(self, topic, count):
        result = self.run_program("quorient", "echo", topic, "--count", count, "--json", "--timeout", 15, "--domain", self.domain)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [exact_json.loads(line) for line in result.stdout.splitlines()]

    def record(self, topic, count, file):
        command = self.command("quorient", "echo", topic, "--count", count, "--json", "--timeout", 30, "--domain", self.domain)
        with file.open("w") as output:
            recorder = subprocess.Popen(command, env=self.environment, stdout=output)
        self.processes.append(recorder)
        return recorder

    def run_demo(self, *arguments):
        self.start("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--json", "--set", "source.duration_s=120",
                   "--set", "source.faults=[]", "--set", "expect=null", *arguments)
        self.wait_until_it_runs()

    def wait_until_it_runs(self):
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs")

    def kill_publisher(self):
        status = exact_json.loads(self.run_program("quorient", "status", "--domain", self.domain, "--json").stdout)
        publisher = next(service for service in status["services"] if service["name"] == "sensor")
        epoch = self.echo("frame", 1)[0]["epoch"]
        os.kill(publisher["process"], signal.SIGKILL)
        self.eventually(lambda: self.echo("voter_output", 1)[0]["epoch"] > epoch, "a new epoch")

    def reset(self, attitude):
        result = self.run_program("quorient", "reset", "--attitude", ",".join(map(repr, attitude)), "--domain", self.domain)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        sequences = re.findall(r"attitude-(\w): attitude reset by command as of sequence (\d+)", result.stdout)
        self.assertEqual([lane for lane, _ in sorted(sequences)], ["a", "b", "c"])
        self.assertEqual(len({sequence for _, sequence in sequences}), 1, "all lanes at one frame")
        return int(sequences[0][1])

    def level(self):
        return self.echo("voter_output", 1)[0]["level"]


class Alignment(RunningUnit):
    def test_reset_states_the_attitude_at_one_frame_for_all_lanes(self):
        self.run_demo()
        file = self.run_directory / "truth.json"
        truth = self.record("truth", 1600, file)
        self.eventually(lambda: file.stat().st_size > 0, "the truth is recorded")
        stated = [0.5, -0.5, 0.5, 0.5]
        before = self.echo("voter_output", 1)[0]["reset_counter"]
        sequence = self.reset(stated)
        self.eventually(lambda: self.level() == FULL, "all lanes agree again")
        after = self.echo("voter_output", 20)
        self.assertEqual(truth.wait(timeout=30), 0)
        true_attitude = {sample["sequence_number"]: sample["attitude"] for sample in map(exact_json.loads, file.read_text().splitlines())}
        compared = 0
        for sample in after:
            self.assertEqual(sample["reset_counter"], before + 1)
            if sample["sequence_number"] not in true_attitude:
                continue
            turned = product(conjugate(true_attitude[sequence]), true_attitude[sample["sequence_number"]])
            self.assertLess(angle(sample["attitude"], product(stated, turned)), 2e-6)
            compared += 1
        self.assertGreater(compared, 10)

    def test_a_quaternion_that_is_none_is_refused(self):
        self.run_demo()
        result = self.run_program("quorient", "reset", "--attitude", "1,1,0,0", "--domain", self.domain)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("not a unit quaternion", result.stdout)

    def test_a_killed_publisher_leaves_the_attitude_lost_until_it_is_stated_again(self):
        self.run_demo()
        self.kill_publisher()
        for sample in self.echo("voter_output", 40):
            self.assertEqual(sample["level"], LOST_LEVEL)
        self.reset([1.0, 0.0, 0.0, 0.0])
        self.eventually(lambda: self.level() == FULL, "aligned again")


@unittest.skipUnless(RECORDING.exists(), f"no recording at {RECORDING}")
class LevelledStart(RunningUnit):
    def setUp(self):
        super().setUp()
        self.start("quorient", "launch", CONFIGURATIONS / "mimu4444.yaml", "--log", RECORDING, "--domain", self.domain, "--json",
                   "--set", "source.to_s=25", "--set", "source.faults=[]", "--set", "expect=null", "--set", "unit.initial_attitude={heading_deg: 30}")
        self.wait_until_it_runs()

    def expect_level(self):
        attitude = self.echo("voter_output", 1)[0]["attitude"]
        force = specific_force_at_rest(RECORDING, 8)
        norm = math.hypot(*force)
        self.assertAlmostEqual(norm, 1, delta=0.05)
        up = gravity_in_body(attitude)
        self.assertLess(math.dist(up, [component / norm for component in force]), 3e-3, "up, by the accelerometers alone")
        w, x, y, z = attitude
        self.assertAlmostEqual(math.degrees(math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))), 30, delta=0.3)

    def test_of_a_recording_stands_as_its_accelerometers_feel(self):
        self.expect_level()

    def test_a_publisher_that_measures_its_attitude_again_is_not_lost(self):
        self.kill_publisher()
        self.eventually(lambda: self.level() == FULL, "aligned by measurement")
        self.expect_level()


if __name__ == "__main__":
    unittest.main(verbosity=2)
