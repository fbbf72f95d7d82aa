"""quorient record in MCAP: read and rewritten by Foxglove's own libraries, replayed bit for bit, cut by kill -9, rotated."""
import csv
import json
import pathlib
import subprocess
import time
import unittest

from integration_tests.harness.node_packages import node_modules, run_script
from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest

SCRIPTS = pathlib.Path(__file__).resolve().parents[1] / "records"
DEMO = CONFIGURATIONS / "demo.yaml"
TOPICS = ("cluster", "frame", "truth", "verdict", "attitude", "voter_output", "voted", "event", "status")  # those that the demo writes
RATE_HZ = 200
LONGEST_UNWRITTEN_S = 1.5  # a chunk of a second, the queue's 0.1 s, and a busy machine


class RecordTest(ProcessTest):
    def setUp(self):
        super().setUp()
        self.start("quorient", "launch", DEMO, "--domain", self.domain, "--json", "--set", "source.duration_s=120", "--set", "source.faults=[]", "--set", "expect=null")
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs")

    def path(self, name):
        return self.run_directory / name

    def record(self, name, *arguments):
        return self.start("quorient", "record", self.path(name), "--domain", self.domain, *arguments)

    def ended(self, process, code=0):
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, code, output)
        return output

    def node(self, script, *arguments):
        return run_script(SCRIPTS / script, self.run_directory, *arguments)

    def check(self, name):
        """What Foxglove's libraries read of a file: a summary, and the frames as rows of numbers."""
        found = json.loads(self.node("check_record.mjs", self.path(name), self.path(name + ".frames")))
        with open(self.path(name + ".frames")) as file:
            rows = [[int(time_ns), *map(float, increments)] for time_ns, *increments in csv.reader(file)]
        for topic, facts in found["topics"].items():
            self.assertEqual((facts["differ"], facts["outOfSequence"]), (0, 0), f"{topic}: encoded again it has other bytes, or numbers are missing")
        return found, rows

    def replay(self, name):
        ended = self.run_program("quorient", "replay", self.path(name), "--system", DEMO, "--set", "expect=null", "--json")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return json.loads(ended.stdout)


class ReadByOthers(RecordTest):
    def test_gives_every_sample_as_it_was_and_is_replayed_from_any_rewriting(self):
        node_modules()
        together = self.record("flight.mcap", "--duration", 6), self.record("flight.csv", "--duration", 6)
        text = self.ended(together[0])
        self.ended(together[1])
        found, rows = self.check("flight.mcap")

        self.assertTrue(found["ended"])
        counts = {topic: facts["messages"] for topic, facts in found["topics"].items()}
        for topic in TOPICS:
            self.assertGreater(counts[f"quorient/{topic}"], 0, topic)
        self.assertEqual(found["compressions"], ["zstd"])
        self.assertEqual(found["indexed"], {topic: count for topic, count in counts.items() if count})
        self.assertEqual(found["statistics"]["messageCount"], sum(counts.values()))
        self.assertIn(f"flight.mcap: {counts['quorient/frame']} frames", text)
        self.assertIn(f"{sum(counts.values())} samples in all", text)
        self.compare_with_csv(rows)
        self.compare_viewers(found, counts)

        whole = self.replay("flight.mcap")
        self.assertEqual(whole["frames"], counts["quorient/frame"])
        self.assertEqual(whole["isolations"], [])
        if "never arrived" not in text:
            self.assertLess(whole["attitude"]["max_error_rad"], 1e-5, "against the truth in the file")
        for kind in ("none", "unchunked", "lz4"):
            with self.subTest(rewritten=kind):
                self.node("rewrite_record.mjs", self.path("flight.mcap"), self.path(f"{kind}.mcap"), kind)
                again, _ = self.check(f"{kind}.mcap")
                self.assertEqual({topic: facts["sha256"] for topic, facts in again["topics"].items()}, {topic: facts["sha256"] for topic, facts in found["topics"].items()})
                self.assertEqual(self.replay(f"{kind}.mcap"), whole)
        self.node("rewrite_record.mjs", self.path("flight.mcap"), self.path("brotli.mcap"), "brotli")
        ended = self.run_program("quorient", "replay", self.path("brotli.mcap"), "--system", DEMO)
        self.assertEqual(ended.returncode, 2)
        self.assertIn("compressed by 'brotli'", ended.stderr)

    def compare_with_csv(self, rows):
        """Another process recorded the same frames as text with 17 digits."""
        with open(self.path("flight.csv")) as file:
            _, *lines = csv.reader(file)
        by_time = {int(seconds.replace(".", "")): list(map(float, increments)) for seconds, *increments in lines}
        common = [(increments, by_time[time_ns]) for time_ns, *increments in rows if time_ns in by_time]
        self.assertGreater(len(common), 4 * RATE_HZ)
        self.assertTrue(all(ours == theirs for ours, theirs in common), "frames differ between the two records")

    def compare_viewers(self, found, counts):
        self.assertEqual(counts["/attitude/transform"], counts["quorient/voted"])
        self.assertEqual(counts["/imu/data"], counts["quorient/voted"])
        w, x, y, z = found["lastVoted"]["attitude"]
        self.assertEqual(found["lastTransform"]["rotation"], {"x": x, "y": y, "z": z, "w": w})
        self.assertEqual((found["lastTransform"]["parent_frame_id"], found["lastTransform"]["child_frame_id"]), ("reference", "body"))
        imu = found["lastImu"]
        self.assertEqual(imu["orientation"], {"x": x, "y": y, "z": z, "w": w})
        self.assertEqual(list(imu["angular_velocity"].values()), found["lastVoted"]["rate_rad_s"])
        self.assertEqual(imu["header"]["frame_id"], "body")


class Killed(RecordTest):
    def test_record_is_read_up_to_its_last_second_by_others_and_by_replay(self):
        node_modules()
        process = self.record("killed.mcap")
        self.eventually(lambda: self.path("killed.mcap").exists() and self.path("killed.mcap").stat().st_size > 1_000_000, "a megabyte is written")
        killed_ns = time.time_ns()
        process.kill()
        process.wait()
        found, rows = self.check("killed.mcap")
        self.assertFalse(found["ended"])
        self.assertGreater(found["lastLogTime"], killed_ns - LONGEST_UNWRITTEN_S * 1e9)
        self.assertGreater(len(rows), RATE_HZ)
        self.assertEqual(self.replay("killed.mcap")["frames"], len(rows))


class Rotated(RecordTest):
    def test_by_time_gives_files_that_are_complete_alone_and_together(self):
        node_modules()
        text = self.ended(self.record("flight.mcap", "--rotate-s", 1, "--duration", 4.5))
        names = sorted(path.name for path in self.run_directory.glob("flight_*.mcap"))
        self.assertGreaterEqual(len(names), 4, text)
        self.assertEqual(names[0], "flight_0000.mcap")
        self.assertFalse(self.path("flight.mcap").exists())
        all_rows = []
        for name in names:
            found, rows = self.check(name)
            self.assertTrue(found["ended"])
            self.assertGreater(found["topics"]["quorient/cluster"]["messages"], 0, "no description")
            self.assertEqual(self.replay(name)["frames"], len(rows))
            all_rows += rows
        steps = {round((after[0] - before[0]) / 1e6) for before, after in zip(all_rows, all_rows[1:])}
        self.assertEqual(steps, {1000 // RATE_HZ}, "a frame is missing between two files, or in both")

    def test_by_size_ends_files_near_it_and_refuses_names_that_exist(self):
        limit = 300_000
        self.ended(self.record("flight.mcap", "--rotate-mb", limit / 1e6, "--duration", 6))
        *full, last = sorted(self.run_directory.glob("flight_*.mcap"))
        self.assertGreaterEqual(len(full), 2)
        for path in full:
            self.assertGreaterEqual(path.stat().st_size, limit)
            self.assertLess(path.stat().st_size, limit + 1_500_000, "the limit, a chunk of a second, and the summary")
        before = full[0].read_bytes()
        self.assertIn("exists already", self.ended(self.record("flight.mcap", "--rotate-mb", 1, "--duration", 1), code=2))
        self.assertEqual(full[0].read_bytes(), before)

    def test_of_a_csv_is_refused(self):
        self.assertIn("for MCAP files", self.ended(self.record("flight.csv", "--rotate-s", 1), code=2))


class FullDisk(RecordTest):
    def test_keeps_whole_samples_and_says_how_many(self):
        possible = subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "none", "/mnt"], capture_output=True, text=True, timeout=10)
        if possible.returncode:
            self.skipTest(f"no disk of its own: {possible.stderr.strip()}")
        script = 'mount -t tmpfs -o size=400k none "$1" && "$2" record "$1/flight.mcap" --domain "$3" --duration 60; code=$?; cp "$1/flight.mcap" "$4"; exit $code'
        disk = self.path("disk")
        disk.mkdir()
        command = ["unshare", "-m", "sh", "-c", script, "sh", disk, *self.command("quorient"), str(self.domain), self.path("kept.mcap")]
        ended = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=90)
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertIn("No space left on device", ended.stderr)
        frames = self.replay("kept.mcap")["frames"]
        self.assertGreater(frames, 0)
        self.assertIn(f"{frames} of them frames", ended.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
