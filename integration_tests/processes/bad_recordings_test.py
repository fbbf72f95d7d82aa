"""Recordings that must not hurt: an error with its place, or refusals that are counted while the rest is played."""
import json
import struct
import unittest

from integration_tests.harness.processes import CONFIGURATIONS, DATA, ProcessTest

RECORDING = DATA / "mimu4444_carlsson/exp_1/data.bin"
FLIGHT = sorted((DATA / "ansfl_quadrotor_4xDOT/StraightLine/RAW").glob("*_1114*.csv"))
OTHER_FLIGHT = [DATA / f"ansfl_quadrotor_4xDOT/Horizontal/path_11/IMU_{number}.csv" for number in range(1, 5)]

ACKNOWLEDGEMENT, PACKET = 4, 106  # bytes
TICKS_PER_S = 64_000_000

FLIGHT_SYSTEM = """
domain: 1
unit: {id: 1}
source: {kind: log, file: named by the command, calibration: cluster.yaml, rate_hz: 120, rest_s: 0}
lanes:
  - {name: a, detector: {method: accumulating, instruments: true}}
voters:
  - {name: voter-1}
"""


def packets(seconds):
    """The recording's beginning: it rests."""
    data = RECORDING.read_bytes()[: ACKNOWLEDGEMENT + PACKET * int(seconds * 62.5)]
    return data[:ACKNOWLEDGEMENT], [bytearray(data[i : i + PACKET]) for i in range(ACKNOWLEDGEMENT, len(data), PACKET)]


def sealed(packet):
    packet[-2:] = struct.pack(">H", sum(packet[:-2]) & 0xFFFF)
    return packet


@unittest.skipUnless(RECORDING.exists(), f"no recording at {RECORDING}")
class Array(ProcessTest):
    needs_quiet_machine = False

    def replay(self, content):
        log = self.run_directory / "log.bin"
        log.write_bytes(content)
        return self.run_program(
            "quorient", "replay", log, "--system", CONFIGURATIONS / "mimu4444.yaml", "--set", "expect=null", "--to", 100, "--json"
        )

    def played(self, content):
        result = self.replay(content)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def refused(self, content):
        result = self.replay(content)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("log.bin", result.stderr)
        return result.stderr

    def test_plays_an_undamaged_one_without_a_word(self):
        head, body = packets(20)
        report = self.played(head + b"".join(body))
        self.assertEqual(report["frames"], len(body))
        self.assertEqual(report["log"], "1250 records, 1250 frames, 20.0 s")
        self.assertEqual(report["isolations"], [])

    def test_plays_a_truncated_one_up_to_the_cut(self):
        head, body = packets(20)
        report = self.played((head + b"".join(body))[:-40])
        self.assertEqual(report["frames"], len(body) - 1)
        self.assertIn("66 bytes of a cut record at the end", report["log"])
        self.assertEqual(report["isolations"], [])

    def test_refuses_swapped_byte_order(self):
        head, body = packets(20)
        words = head + b"".join(body)
        swapped = bytearray(words)
        swapped[0::2], swapped[1::2] = words[1::2], words[0::2]
        self.assertRegex(self.refused(bytes(swapped)), r"byte 0: .*wrong byte order")

    def test_refuses_a_constant_file(self):
        for byte in (0, 0xAA):
            self.assertIn("byte", self.refused(bytes([byte]) * 100_000))

    def test_plays_on_after_a_clock_that_jumps_back(self):
        head, body = packets(20)
        for packet in body[700:]:
            ticks = struct.unpack_from(">I", packet, 4)[0]
            struct.pack_into(">I", packet, 4, (ticks - 5 * TICKS_PER_S) & 0xFFFFFFFF)
            sealed(packet)
        report = self.played(head + b"".join(body))
        self.assertEqual(report["frames"], len(body) - 1)
        self.assertIn("1 irregular in time", report["log"])
        self.assertEqual(report["isolations"], [])

    def test_blames_an_instrument_that_is_dead_and_no_other(self):
        head, body = packets(20)
        for packet in body[900:]:
            packet[8 + 4 * 12 : 8 + 5 * 12] = bytes(12)  # IMU5 sends zeros
            sealed(packet)
        report = self.played(head + b"".join(body))
        self.assertEqual(report["frames"], len(body))
        for lane in "abc":
            isolated = {axis for entry in report["isolations"] if entry["lane"] == lane for axis in entry["axes"]}
            self.assertEqual(isolated, {12, 13, 14}, "axes of IMU5")


@unittest.skipUnless(len(FLIGHT) == 4 and OTHER_FLIGHT[0].exists(), "no flights of four DOTs in the data folder")
class SeveralLogs(ProcessTest):
    needs_quiet_machine = False

    def setUp(self):
        super().setUp()
        self.system = self.write("flight.yaml", FLIGHT_SYSTEM)
        self.cluster = self.write("cluster.yaml", "")
        calibrated = self.run_program("quorient", "calibrate", *OTHER_FLIGHT, "--out", self.cluster, "--force", timeout=120)
        self.assertEqual(calibrated.returncode, 0, calibrated.stderr)
        names = {"IMU_1": "DOT1", "IMU_2": "DOT2", "IMU_3": "DOT4", "IMU_4": "DOT7"}
        text = self.cluster.read_text()
        for name, device in names.items():
            text = text.replace(f'"{name}"', f'"{device}"')
        self.cluster.write_text(text)

    def replay(self, *logs):
        return self.run_program("quorient", "replay", *logs, "--system", self.system, "--to", 50, "--json", timeout=120)

    def test_refuses_two_files_of_different_flights(self):
        result = self.replay(*FLIGHT[:3], OTHER_FLIGHT[3])
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("IMU_4.csv do not show the same motion", result.stderr)

    def test_refuses_a_flight_whose_calibration_has_an_instrument_more(self):
        result = self.replay(*FLIGHT[:3])
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("12 axes, the log has 9", result.stderr)

    def test_refuses_the_files_in_another_order_than_the_calibration(self):
        result = self.replay(FLIGHT[1], FLIGHT[0], *FLIGHT[2:])
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("axis 0 is of instrument DOT1, in the log of DOT2", result.stderr)

    def test_goes_on_without_an_instrument_whose_file_breaks_off(self):
        lines = FLIGHT[2].read_text().splitlines(keepends=True)
        cut = self.write(FLIGHT[2].name, "".join(lines[:3600]) + lines[3600][:20])  # after 30 s, within a line
        result = self.replay(FLIGHT[0], FLIGHT[1], cut, FLIGHT[3])
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertGreater(report["frames"], 5900)
        self.assertIn("1 malformed", report["log"])
        self.assertEqual(report["isolations"], [], "DOT4 is absent since 30 s, and silence is no fault")


if __name__ == "__main__":
    unittest.main(verbosity=2)
