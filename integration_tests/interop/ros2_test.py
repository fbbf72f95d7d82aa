"""ROS 2 on the wire, with plain DDS nodes in ROS 2's place: they receive what our voters write, and what their IMUs write is integrated."""
import json
import math
import re
import shutil
import signal
import subprocess
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.foreign import InteropTest, node
from integration_tests.harness.processes import CONFIGURATIONS
from integration_tests.harness.quaternion import angle, conjugate, product

IMU_LINE = re.compile(
    r"(\S+) (\S*) q (\S+) (\S+) (\S+) (\S+) covariance (\S+) rate (\S+) (\S+) (\S+) covariance (\S+) acceleration covariance (\S+)"
)
PROFILES = ("sensor-data", "default")
VENDORS = ("cyclonedds", "fastdds")


class Imu:
    def __init__(self, line):
        found = IMU_LINE.fullmatch(line)
        assert found, f"not an IMU message: {line!r}"
        second, fraction = found.group(1).split(".")
        self.stamp_ns = int(second) * 10**9 + int(fraction)
        self.frame_id = found.group(2)
        self.attitude = [float(found.group(i)) for i in range(3, 7)]
        self.orientation_variance, *rate, self.rate_variance, self.acceleration_variance = map(float, found.groups()[6:])
        self.rate = rate


def imus(log):
    return [Imu(line) for line in log.read_text().split("\n")[:-1]]


class Ros2Test(InteropTest):
    def read(self, vendor, what, topic, profile):
        return self.start_logged(f"{what}-{vendor}-{profile}", *node(f"ros2_node_{vendor}"), self.domain, what, topic, profile)[1]

    def start_pipeline(self, configuration, *settings):
        arguments = [argument for setting in settings for argument in ("--set", setting)]
        return self.start_services(configuration, *arguments, sensor=True)

    def echo_logged(self, topic):
        return self.start_logged(f"echo-{topic}", *self.command("quorient", "echo", topic, "--json", "--domain", self.domain))[1]


class Out(Ros2Test):
    def start_demo(self):
        return self.start_pipeline(
            CONFIGURATIONS / "demo.yaml", "source.duration_s=60", "source.faults=['axis=1,kind=scale,value=0.8,start=2']",
            "ros2={imu: /imu/data, frame_id: gyros, every: 4, stamp: sample}",
        )

    def test_voted_attitude_is_heard_in_both_profiles_by_both_vendors_from_one_voter_at_a_time(self):
        truths = self.echo_logged("truth")
        logs = {(v, p): self.read(v, "imu", "rt/imu/data", p) for v in VENDORS for p in PROFILES}
        diagnostics = {v: self.read(v, "diagnostics", "rt/diagnostics", "default") for v in VENDORS}
        services = self.start_demo()
        for reader, log in logs.items():
            self.eventually(lambda: len(imus(log)) > 200, f"200 messages at {reader}", timeout=30)
        for vendor, log in diagnostics.items():
            self.eventually(lambda: "|quorient: axis 1 (G2)|isolated|unit 1" in log.read_text(), f"the isolated axis in {vendor}'s diagnostics")
            for line in ("0|quorient: axis 0 (G1)|in use|", "0|quorient: voter 1|owns the output|", "0|quorient: voter 2|stands by|"):
                self.assertIn(line, log.read_text())
        if shutil.which("tshark"):
            self.assert_tshark_names_the_topics()
        truth = {sample["sample_time_ns"]: sample for sample in exact_json.objects(truths)}
        for (vendor, profile), log in logs.items():
            with self.subTest(vendor=vendor, profile=profile):
                self.assert_true(imus(log), truth)
        self.hand_over(services, logs, diagnostics)

    def assert_true(self, messages, truth):
        compared = [(imu, truth[imu.stamp_ns]) for imu in messages if imu.stamp_ns in truth]
        self.assertGreater(len(compared), 150)
        for imu, true in compared:
            self.assertEqual(imu.frame_id, "gyros")
            self.assertEqual(true["sequence_number"] % 4, 0, "every fourth frame")
            self.assertLess(angle(imu.attitude, true["attitude"]), 1e-3)  # the few frames until the fault is isolated
            self.assertGreater(imu.orientation_variance, 0)
            self.assertEqual(imu.acceleration_variance, -1)
        late = [(imu, true) for imu, true in compared if true["sequence_number"] > 420]
        self.assertLess(max(angle(imu.attitude, true["attitude"]) for imu, true in late), 3e-6)
        # The rate is a difference of quantised angles: five of its own standard deviations, and the change within an interval.
        for imu, true in late:
            allowed = 5 * math.sqrt(imu.rate_variance) + 1e-3
            self.assertLess(max(abs(a - b) for a, b in zip(imu.rate, true["rate_rad_s"])), allowed)

    def hand_over(self, services, logs, diagnostics):
        before = {reader: len(imus(log)) for reader, log in logs.items()}
        services["voter-1"][0].kill()
        for vendor, log in diagnostics.items():
            self.eventually(lambda: "0|quorient: voter 2|owns the output|" in log.read_text(), f"voter 2 writes diagnostics to {vendor}")
        for reader, log in logs.items():
            self.eventually(lambda: len(imus(log)) > before[reader] + 50, f"messages go on at {reader}")
            stamps = [imu.stamp_ns for imu in imus(log)]
            twice = len(stamps) - len(set(stamps))
            # Each hand-over may send a few frames twice; two voters at a time would send all of them twice.
            self.assertLess(twice, 0.1 * len(stamps))

    def assert_tshark_names_the_topics(self):
        file = self.run_directory / "capture.pcapng"
        file.touch()
        file.chmod(0o666)  # the capture may run as another user
        # Discovery goes to even ports [RTPS 9.6.1.1]; the data would be far more.
        ports = f"udp dst portrange {7400 + 250 * self.domain}-{7400 + 250 * self.domain + 80} and udp[3] & 1 = 0"
        tshark = subprocess.Popen(["tshark", "-i", "lo", "-f", ports, "-w", file], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.processes.append(tshark)
        if "permission" in (tshark.stderr.readline() + tshark.stderr.readline()).lower():
            return
        fields = ["-T", "fields", "-e", "rtps.param.topicName", "-e", "rtps.param.typeName"]
        names = {"rt/imu/data", "sensor_msgs::msg::dds_::Imu_", "rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_"}

        def named():
            # Discovery sends the names to a participant that joins.
            self.run_program("quorient", "echo", "status", "--count", 5, "--timeout", 3, "--domain", self.domain)
            decoded = subprocess.run(["tshark", "-r", file, "-Y", "rtps.param.topicName", *fields], capture_output=True, text=True, timeout=60)
            return names <= set(decoded.stdout.replace(",", "\t").split())

        self.eventually(named, f"tshark reads {names}", timeout=30)
        tshark.terminate()

    def test_nothing_is_written_for_ros_2_unless_asked_for(self):
        self.start_pipeline(CONFIGURATIONS / "demo.yaml", "source.duration_s=20", "source.faults=[]")
        log = self.read("cyclonedds", "imu", "rt/imu/data", "sensor-data")
        self.eventually(lambda: any(voted["sequence_number"] > 300 for voted in self.echo("voter_output", 70)[-1:]), "the pipeline runs")
        self.assertEqual(imus(log), [])


FOUR_IMUS = """
name: a robot's IMUs
domain: 42
dds: cyclonedds
interface: lo
unit: {id: 1, name: robot, initial_attitude: [1, 0, 0, 0]}
source:
  kind: ros2_imu
  rate_hz: 100
  skew_s: 0.1
  noise_rad: 1.0e-6
  imus:
    - {topic: /imu_1/data, name: front}
    - {topic: /imu_2/data, name: middle, rotation: [0.5, 0.5, 0.5, 0.5], position_m: [0.1, 0, 0]}
    - {topic: /imu_3/data, name: rear, rotation: [0, 0, 0, 1], position_m: [-0.2, 0, 0.1]}
    - {topic: /imu_4/data, name: top}
lanes:
  - {name: a, detector: {method: subset, instruments: true, max_faults: 1, pfa: 1.0e-9}}
  - {name: b, dds: fastdds, detector: {method: subset, instruments: true, max_faults: 1, pfa: 1.0e-9}}
  - {name: c, detector: {method: subset, instruments: true, max_faults: 1, pfa: 1.0e-9}}
voters: [{name: voter-1}, {name: voter-2, dds: fastdds}]
voting: {patience: 1, silence_intervals: 10}
"""
NORMAL = 2
BODY_RATE = (0.1, 0.2, -0.3)
ALL, MIDDLE, REAR = 0xFFF, 0b000000111000, 0b000111000000


def turned(seconds):
    rate = math.hypot(*BODY_RATE)
    half = rate * seconds / 2
    return [math.cos(half), *(component / rate * math.sin(half) for component in BODY_RATE)]


class In(Ros2Test):
    """One robot, one pipeline, each mistake of its second IMU in turn, then a real fault of the third."""

    def test_a_faulty_imu_costs_its_own_axes_and_nothing_else(self):
        configuration = self.write("robot.yaml", FOUR_IMUS)
        events, frames, voted = (self.echo_logged(topic) for topic in ("event", "frame", "voter_output"))
        # The robot is this machine's in any case: release-root passes only SIGINT and SIGTERM on.
        robot, said = self.start_logged("robot", *node("ros2_node_cyclonedds"), self.domain, "robot")
        services = self.start_pipeline(configuration)
        self.eventually(lambda: any(v["mode"] == NORMAL for v in exact_json.objects(voted)), "the robot's attitude is voted on", timeout=30)

        def events_with(words):
            return [e for e in exact_json.objects(events) if e["source_name"] == "sensor" and words in e["text"]]

        for round_, words in enumerate(("silent", "its stamps are off", "its stamps are off", "duplicated"), 1):
            since = len(events_with("middle"))
            robot.send_signal(signal.SIGUSR1)  # silent, late, ahead, doubled
            self.eventually(lambda: any(words in e["text"] for e in events_with("middle")[since:]), f"{words} ({round_})")
            self.assertEqual({e["axes"] for e in events_with("middle")}, {MIDDLE})
            robot.send_signal(signal.SIGUSR1)  # well
            self.eventually(lambda: len(events_with("middle: measures again")) >= round_ and "again" in events_with("middle")[-1]["text"], f"well ({round_})")
        robot.send_signal(signal.SIGUSR1)
        self.eventually(lambda: any(v["isolated_mask"] & REAR == REAR for v in exact_json.objects(voted)), "the third IMU's bias isolated")
        self.all_alive(services)

        masks = {frame["valid_mask"] for frame in exact_json.objects(frames)}
        self.assertEqual(masks, {ALL, ALL & ~MIDDLE}, "only the second IMU's axes are ever missing, and all three of them")
        named = {v["isolated_mask"] for v in exact_json.objects(voted)}
        self.assertLessEqual(named, {0, MIDDLE, REAR, MIDDLE | REAR}, "only an IMU that is silent for long and the biased one are excluded")
        self.assert_attitude_is_true(exact_json.objects(voted))
        self.assertIn("biased", said.read_text())

    def assert_attitude_is_true(self, voted):
        good = [v for v in voted if v["mode"] == NORMAL]
        first = good[0]
        for sample in good:
            since_s = (sample["sample_time_ns"] - first["sample_time_ns"]) * 1e-9
            moved = product(conjugate(first["attitude"]), sample["attitude"])
            # The noise is 1e-4 rad/s and does not add up; the bias counts for the few frames until it is isolated.
            self.assertLess(
                angle(moved, turned(since_s)), 5e-4 if sample["isolated_mask"] or sample["suspect_mask"] else 2e-5,
                f"{since_s:.2f} s after the first of {len(good)} samples: {sample}",
            )


BIASED = """
name: three IMUs with biases that nobody has calibrated
domain: 42
dds: cyclonedds
interface: lo
unit: {id: 1, name: robot, initial_attitude: [1, 0, 0, 0]}
source:
  kind: ros2_imu
  rate_hz: 200
  skew_s: 0.1
  imus:
    - {topic: /imu_1/data, name: front}
    - {topic: /imu_2/data, name: middle}
    - {topic: /imu_3/data, name: rear}
lanes: [{name: a}, {name: b, dds: fastdds}, {name: c}]
voters: [{name: voter-1}, {name: voter-2, dds: fastdds}]
"""
# As ros2_node_cyclonedds measures them.
BIASES_DEG_S = (0.31, -0.22, 0.45, -0.6, 0.27, 0.38, -0.41, 0.2, 0.55)
AMPLITUDE_RAD_S, PACE = (0.5, 0.4, 0.6), (1.1, 0.7, 0.9)
WATCHED_S = 20  # of motion
LEARNED = "bias at rest"


def attitude_after(seconds, step_s=1e-3):
    """The body's true attitude so long after it began to turn, by turns of a millisecond."""
    attitude = [1, 0, 0, 0]
    for k in range(round(seconds / step_s)):
        turn = [amplitude * math.sin(pace * (k + 0.5) * step_s) * step_s for amplitude, pace in zip(AMPLITUDE_RAD_S, PACE)]
        angle_rad = math.hypot(*turn)
        scale = math.sin(angle_rad / 2) / angle_rad if angle_rad > 0 else 0.5
        attitude = product(attitude, [math.cos(angle_rad / 2), *(scale * component for component in turn)])
    return attitude


class Uncalibrated(Ros2Test):
    """Biases that the class of sensors allows cost no axis and no attitude; a real fault of one of these IMUs is isolated."""

    def start_biased(self):
        self.topics = {topic: self.echo_logged(topic) for topic in ("event", "cluster", "verdict", "voter_output")}
        self.imus, self.said = self.start_logged("imus", *node("ros2_node_cyclonedds"), self.domain, "biased")
        self.system = self.write("biased.yaml", BIASED)
        self.services = self.start_pipeline(self.system)
        self.eventually(lambda: self.said.read_text().endswith("\n"), "the IMUs say when they will turn")
        self.turns_ns = int(self.said.read_text())

    def received(self, topic):
        return exact_json.objects(self.topics[topic])

    def turned_for(self, seconds):
        last = self.received("voter_output")[-1:]
        return bool(last) and last[0]["sample_time_ns"] > self.turns_ns + seconds * 1e9

    def assert_biases_were_learned_first(self):
        texts = [event["text"] for event in self.received("event") if LEARNED in event["text"]]
        self.assertEqual(sorted(text.split(":")[0] for text in texts), ["front", "middle", "rear"], texts)
        description = self.received("cluster")[-1]
        for found, bias in zip(description["bias"], BIASES_DEG_S):
            self.assertAlmostEqual(math.degrees(found), bias, delta=0.02)
        self.assertTrue(all(sigma > 0 for sigma in description["sigma"][:9]))
        self.assertEqual(description["revision"], 2, "the frames carry this one alone")

    def test_three_sound_imus_keep_all_axes_and_the_attitude_is_true(self):
        recording = self.run_directory / "run.mcap"
        recorder = self.start("quorient", "record", recording, "--domain", self.domain)
        self.start_biased()
        self.eventually(lambda: self.turned_for(WATCHED_S), f"{WATCHED_S} s of motion", timeout=60)
        self.all_alive(self.services)
        recorder.send_signal(signal.SIGINT)
        self.assertEqual(recorder.wait(20), 0, recorder.stdout.read())
        self.assert_biases_were_learned_first()
        verdicts, voted = self.received("verdict"), self.received("voter_output")
        self.assertGreater(len(verdicts), 3 * 200 * WATCHED_S)
        self.assertEqual({verdict["isolated_mask"] for verdict in verdicts}, {0})
        self.assertEqual({sample["isolated_mask"] for sample in voted}, {0})
        left_out = [event["text"] for event in self.received("event") if "LEFT OUT" in event["text"]]
        self.assertEqual(left_out, [])
        last = voted[-1]
        error = angle(last["attitude"], attitude_after((last["sample_time_ns"] - self.turns_ns) * 1e-9))
        # With the mean of the biases left in, 0.2 to 0.5 deg/s, it would be 8 deg and more.
        self.assertLess(math.degrees(error), 0.3)
        self.assert_it_replays(recording, len(verdicts) / 3)

    def assert_it_replays(self, recording, frames):
        result = self.run_program("quorient", "replay", recording, "--system", self.system, "--json", timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertGreater(report["frames"], 0.9 * frames)
        self.assertEqual(report["isolations"], [])

    def test_a_calibration_of_the_running_system_finds_the_raw_biases(self):
        self.start_biased()
        cluster = self.run_directory / "cluster.yaml"
        live = self.run_program(
            "quorient", "calibrate", "--live", self.system, "--domain", self.domain, "--duration", 24, "--json", "--out", cluster, timeout=60
        )
        self.assertEqual(live.returncode, 0, live.stderr)
        axes = json.loads(live.stdout)["axes"]
        self.assertEqual([axis["instrument"] for axis in axes], ["front"] * 3 + ["middle"] * 3 + ["rear"] * 3)
        for axis, bias in zip(axes, BIASES_DEG_S):
            self.assertAlmostEqual(math.degrees(axis["bias_rad_s"]), bias, delta=0.03, msg="of the sensors, not of what the publisher corrected")
            self.assertAlmostEqual(axis["gain"], 1, delta=0.01)
        self.assertIn('instrument: "rear"', cluster.read_text())
        calibrated = self.write("calibrated.yaml", BIASED.replace("rate_hz: 200", "rate_hz: 200\n  calibration: cluster.yaml"))
        checked = self.run_program("quorient", "check", calibrated)
        self.assertEqual(checked.returncode, 0, checked.stderr)

    def test_a_real_fault_of_one_of_them_is_isolated(self):
        self.start_biased()
        self.eventually(lambda: self.turned_for(3), "motion", timeout=60)
        self.assertEqual({sample["isolated_mask"] for sample in self.received("voter_output")}, {0})
        self.imus.send_signal(signal.SIGUSR1)
        self.eventually(lambda: any(sample["isolated_mask"] == REAR for sample in self.received("voter_output")), "the third IMU is isolated", timeout=15)
        self.assertLessEqual({sample["isolated_mask"] for sample in self.received("voter_output")}, {0, REAR})


if __name__ == "__main__":
    unittest.main(verbosity=2)
