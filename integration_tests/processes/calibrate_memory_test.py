"""quorient calibrate of a long log: bounded memory, and what was put in comes out."""
import json
import math
import os
import random
import subprocess
import unittest

from integration_tests.harness.processes import BIN, ProcessTest

LARGEST_MB = 200
RATE_HZ = 1000
RESTS_S, MOVES_S = 100, 1100  # 1.2 million frames, 108 MB of text: held in memory they take 300 MB
BIAS_DEG_S = (0.31, -0.22, 0.45, -0.6, 0.27, 0.38, -0.41, 0.2, 0.55)
GAIN = (1.01, 0.99, 1.0, 1.0, 1.02, 0.98, 0.99, 0.99, 1.02)  # the mean of each direction is 1: what is common cannot be seen
NOISE_DEG_S = 0.05


def write_log(file, seed=7):
    """Three gyros on one board: at rest, then turning gently about all axes."""
    draw = random.Random(seed)
    noise = [draw.gauss(0, NOISE_DEG_S) for _ in range(9973)]  # drawn once: drawing 11 million takes longer than the calibration
    with open(file, "w") as log:
        log.write("time_s," + ",".join(f"g{m}{axis} [deg/s]" for m in range(3) for axis in "xyz") + "\n")
        for k in range(RATE_HZ * (RESTS_S + MOVES_S)):
            t = k / RATE_HZ
            strength = 20 if t > RESTS_S else 0
            body = [strength * math.sin(rate * t + phase) for rate, phase in ((1.1, 0), (0.7, 1), (0.9, 2))]
            at = 9 * k
            row = ",".join(f"{GAIN[i] * body[i % 3] + BIAS_DEG_S[i] + noise[(at + i) % 9973]:.5f}" for i in range(9))
            log.write(f"{t:.3f},{row}\n")


class LongLog(ProcessTest):
    needs_quiet_machine = False

    def test_takes_at_most_200_mb_and_finds_what_was_put_in(self):
        log = self.run_directory / "long.csv"
        write_log(log)
        process = subprocess.Popen([BIN / "quorient", "calibrate", log, "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.processes.append(process)
        out = process.stdout.read()
        said = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0, said)
        self.assertNotIn("%", said, "no bar where stderr is no terminal")
        self.assertLess(usage.ru_maxrss / 1024, LARGEST_MB)
        for axis, bias, gain in zip(json.loads(out)["axes"], BIAS_DEG_S, GAIN):
            self.assertAlmostEqual(math.degrees(axis["bias_rad_s"]), bias, delta=0.01)
            self.assertAlmostEqual(axis["gain"], gain, delta=0.002)


if __name__ == "__main__":
    unittest.main(verbosity=2)
