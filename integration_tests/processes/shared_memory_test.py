"""Shared memory: it is really in use, seen from outside; its loss and absence are reported; files of killed processes do no harm."""
import contextlib
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import time
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest

DEMO = CONFIGURATIONS / "demo.yaml"
UDP, SHARED_MEMORY, ICEORYX = 2, 3, 4  # codes of ServiceStatus.transport (common/messages)
MEMORY = pathlib.Path("/dev/shm")
FAST_DDS = ("fastrtps_", "sem.fastrtps_", "fastdds_", "sem.fastdds_", "fast_datasharing_")  # its files, of releases 2 and 3
ROUDI = shutil.which("iox-roudi")
ROUDI_SOCKET = "/tmp/roudi"
MAY_MOUNT = os.geteuid() == 0 and shutil.which("unshare")
OWN_PROCESS_IDS = ("unshare", "--pid", "--fork", "--mount-proc", "--kill-child")  # a container's
LANES = (
    "lanes=[{name: a, detector: {method: vector}, transport: iceoryx},"
    "{name: b, dds: fastdds, detector: {method: vector}, transport: shm},"
    "{name: c, transport: iceoryx, detector: {method: extrapolation}}]"
)
ONE_LANE = ("--set", "lanes=[{name: a, detector: {method: vector}}]", "--set", "voters=[{name: voter-1}]")
BY_FASTDDS = ("quorient-fdi", DEMO, "--name", "fdi-a", *ONE_LANE, "--set", "dds=fastdds", "--set", "transport=shm")
BY_ICEORYX = ("quorient-fdi", DEMO, "--name", "fdi-a", *ONE_LANE, "--set", "transport=iceoryx")
MIXED = ("--set", "sensor.transport=iceoryx", "--set", LANES, "--set", "voters=[{name: voter-1, transport: iceoryx},{name: voter-2, dds: fastdds}]")
QUIET = ("--set", "source.faults=[]", "--set", "expect=null", "--set", "source.duration_s=120")


def roudi_answers():
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as probe:
        return probe.connect_ex(ROUDI_SOCKET) == 0


def payload_packets(domain, pattern, seconds):
    """UDP packets of the domain on loopback that carry the bytes."""
    low = 7400 + 250 * domain
    count = 0
    with socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM, socket.htons(0x0800)) as capture:
        capture.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
        capture.bind(("lo", 0))
        capture.settimeout(0.1)
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            with contextlib.suppress(TimeoutError):
                packet, address = capture.recvfrom(65536)
                header = 4 * (packet[0] & 15)
                port = int.from_bytes(packet[header + 2:header + 4], "big")
                outgoing = address[2] == socket.PACKET_OUTGOING  # loopback shows each packet twice
                count += not outgoing and packet[9] == socket.IPPROTO_UDP and low <= port < low + 250 and pattern in packet
    return count


@unittest.skipUnless(ROUDI, "iceoryx is not installed")
class SharedMemory(ProcessTest):
    def setUp(self):
        super().setUp()
        if roudi_answers():
            self.skipTest("an iox-roudi that is not this test's runs on this machine")

    def tearDown(self):
        super().tearDown()
        deadline = time.monotonic() + 5
        while roudi_answers() and time.monotonic() < deadline:  # the launcher's children go with it
            time.sleep(0.02)

    def start_roudi(self, *pools, within=()):
        """@param pools  (size, count) of each; without, those that RouDi has by itself. @param within  a command that runs another one."""
        configuration = "".join(f"[[segment.mempool]]\nsize = {size}\ncount = {count}\n" for size, count in pools)
        file = self.write("own-roudi.toml", "[general]\nversion = 1\n[[segment]]\n" + configuration)
        process = subprocess.Popen([*within, ROUDI, *(["-c", file] if pools else [])], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.processes.append(process)
        self.eventually(roudi_answers, "iox-roudi answers")
        return process

    def start_demo(self, *arguments):
        pipeline = self.start("quorient", "launch", DEMO, "--domain", self.domain, "--json", *MIXED, *arguments)
        self.eventually(lambda: self.frames_of("voter-1") is not None, "the pipeline runs")
        self.goes_on("voter-1")  # not the heartbeat that a run before this one left
        return pipeline

    def start_one_lane(self, *arguments):
        """Its processes without a launcher, whose monitor reads by UDP; the sensor is the last."""
        for program, name in (("quorient-voter", "voter-1"), ("quorient-attitude", "attitude-a"), ("quorient-fdi", "fdi-a"), ("quorient-sensor", "sensor")):
            command = self.command(program, DEMO, "--name", name, "--domain", self.domain, *ONE_LANE, *QUIET, *arguments)
            with open(self.run_directory / f"{name}.log", "w") as log:
                self.processes.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=subprocess.STDOUT))
        return self.processes[-4:]

    def services(self):
        result = self.run_program("quorient", "status", "--domain", self.domain, "--json")
        return {service["name"]: service for service in exact_json.loads(result.stdout)["services"]} if result.stdout else {}

    def frames_of(self, name):
        """None before its first."""
        try:
            return int(self.heartbeat(name).read_text().split()[1])
        except (FileNotFoundError, IndexError):
            return None

    def goes_on(self, name, frames=100):
        begin = self.frames_of(name) or 0
        has_gone_on = lambda now: now is not None and not begin <= now < begin + frames  # noqa: E731
        self.eventually(lambda: has_gone_on(self.frames_of(name)), f"{name} handles frames")

    def log(self, name):
        path = self.run_directory / f"{name}.log"
        return path.read_text() if path.exists() else ""

    def newest_frame(self, *arguments):
        result = self.run_program("quorient", "echo", "frame", "--count", 1, "--json", "--timeout", 10, "--domain", self.domain, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return exact_json.loads(result.stdout.splitlines()[0])

    def our_files(self):
        return [file.name for file in MEMORY.iterdir() if file.name.startswith((*FAST_DDS, "iceoryx_mgmt"))]

    def test_demo_by_shared_memory_is_as_expected_and_status_names_the_transport(self):
        pipeline = self.start_demo("--set", "source.duration_s=12", "--set", "source.faults=['axis=1,kind=scale,value=0.8,start=5,end=10']")
        services = self.services()
        stdout, _ = pipeline.communicate(timeout=60)
        summary = exact_json.loads(stdout[stdout.index("{"):])
        self.assertEqual(pipeline.returncode, 0, summary["unmet"])
        self.assertEqual({name for name, lane in summary["lanes"].items() if lane["isolated"] == [1]}, {"a", "b", "c"})
        by = lambda transport: {name for name, service in services.items() if service["transport"] == transport}  # noqa: E731
        self.assertEqual(by(ICEORYX), {"sensor", "fdi-a", "fdi-c", "attitude-a", "attitude-c", "voter-1"})
        self.assertEqual(by(SHARED_MEMORY), {"fdi-b", "attitude-b"})
        self.assertEqual(by(UDP), {"voter-2"})
        for name in ("fdi-a", "attitude-a", "fdi-b", "voter-1"):
            self.assertNotIn("was asked for", self.log(name))

    def test_systems_of_two_domains_share_one_daemon_and_nothing_else(self):
        """A reader that is handed another domain's samples goes deaf after 256 of them."""
        self.start_roudi()
        own_directory = self.run_directory / "other"
        own_directory.mkdir()
        short = ("--set", "source.duration_s=4", "--set", "source.faults=[]", "--set", "expect={final_error_rad: 1.0e-5}")
        systems = []
        for domain, directory in ((self.domain, self.run_directory), (self.domain + 1, own_directory)):
            command = self.command("quorient", "launch", DEMO, "--domain", domain, "--json", *MIXED, *short)
            environment = {**self.environment, "QUORIENT_RUN_DIR": str(directory)}
            systems.append(subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True))
        self.processes += systems
        for system in systems:
            stdout, _ = system.communicate(timeout=60)
            summary = exact_json.loads(stdout[stdout.index("{"):])
            self.assertEqual(system.returncode, 0, summary["unmet"])
            frames = {name: lane["frames"] for name, lane in summary["lanes"].items()}
            self.assertGreaterEqual(min(frames.values()), 600, frames)  # of 800, and at most about 450 where they are deaf

    @unittest.skipUnless(os.geteuid() == 0, "capturing on loopback needs root")
    def test_samples_lie_in_the_segment_and_not_on_the_network(self):
        self.start_roudi()
        for transport in ("iceoryx", "udp"):
            with self.subTest(transport=transport):
                processes = self.start_one_lane("--set", f"transport={transport}")
                self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the lane runs")
                frame = self.newest_frame()  # its reader has left when the capture begins
                epoch = struct.pack("<Q", frame["epoch"])
                packets = payload_packets(self.domain, epoch, 1)
                segments = [file for file in MEMORY.iterdir() if not file.name.startswith((*FAST_DDS, "sem.", "iceoryx_mgmt"))]
                samples = sum(file.read_bytes().count(epoch) for file in segments)
                if transport == "iceoryx":
                    self.assertLess(packets, 20)  # events and the reader that leaves; three topics at 200 Hz make 600
                    self.assertGreater(samples, 20)
                else:
                    self.assertGreater(packets, 400)
                    self.assertEqual(samples, 0)
                for process in processes:
                    process.send_signal(signal.SIGTERM)
                for process in processes:
                    self.assertEqual(process.wait(timeout=10), 0)

    def test_without_roudi_a_process_says_so_within_a_second_or_goes_by_udp_with_an_alarm(self):
        begin = time.monotonic()
        self.run_program(*BY_ICEORYX, "--set", "security=true")  # what a refusal takes here at least, on a busy machine too
        least = time.monotonic() - begin
        refused = self.run_program(*BY_ICEORYX, "--domain", self.domain)
        self.assertLess(time.monotonic() - begin, 2 * least + 1)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("iox-roudi does not answer", refused.stderr)
        processes = self.start_one_lane("--set", "transport=iceoryx", "--set", "shared_memory=preferred")
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the lane runs")
        events = self.run_program("quorient", "echo", "event", "--json", "--count", 8, "--timeout", 5, "--domain", self.domain)
        alarms = [event for event in map(exact_json.loads, events.stdout.splitlines()) if "iceoryx was asked for" in event["text"]]
        self.assertTrue(alarms, events.stdout)
        self.assertEqual({event["severity"] for event in alarms}, {3})
        for process in processes:
            process.terminate()

    def in_other_memory(self, options, *command):
        """A process whose /dev/shm is another file system."""
        script = f'mount -t tmpfs -o {options} tmpfs /dev/shm && exec "$@"'
        process = subprocess.Popen(
            ["unshare", "-m", "sh", "-c", script, "sh", *self.command(*command)], env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self.processes.append(process)
        return process

    @unittest.skipUnless(MAY_MOUNT, "another /dev/shm needs root")
    def test_a_silent_fallback_of_fastdds_raises_the_alarm_or_is_refused(self):
        for options, choice, expected in (("ro", "preferred", True), ("size=1m", "preferred", True), ("rw", "required", False)):
            with self.subTest(options=options):
                process = self.in_other_memory(options, *BY_FASTDDS, "--domain", self.domain, "--set", f"shared_memory={choice}")
                self.eventually(lambda: self.heartbeat("fdi-a").exists(), "the detector runs")
                time.sleep(1.2)  # two checks of its endpoints: silence can only be seen by waiting
                process.terminate()
                reported = "shm was asked for" in process.communicate(timeout=10)[0]
                self.heartbeat("fdi-a").unlink()
                self.assertEqual(reported, expected)
        for options, reason in (("ro", "cannot open its shared memory"), ("size=1m", "needs 4 MiB in /dev/shm")):
            with self.subTest(options=options):
                process = self.in_other_memory(options, *BY_FASTDDS, "--domain", self.domain)
                self.assertIn(reason, process.communicate(timeout=20)[0])
                self.assertNotEqual(process.returncode, 0)

    @unittest.skipUnless(MAY_MOUNT, "another /dev/shm needs root")
    def test_launch_says_how_much_shared_memory_is_missing(self):
        process = self.in_other_memory("size=8m", "quorient", "launch", DEMO, "--domain", self.domain, *MIXED, *QUIET)
        self.assertRegex(process.communicate(timeout=30)[0], r"needs \d+ MiB in /dev/shm, 8 MiB are free")
        self.assertEqual(process.returncode, 1)

    def test_shared_memory_together_with_security_is_refused_by_both_vendors(self):
        keys = self.run_directory / "keys"
        made = self.run_program("quorient", "keys", DEMO, "--out", keys, "--domain", self.domain)
        self.assertEqual(made.returncode, 0, made.stderr)
        for dds, transport in (("cyclonedds", "iceoryx"), ("fastdds", "shm")):
            with self.subTest(dds=dds):
                refused = self.run_program(
                    "quorient-fdi", DEMO, "--name", "fdi-a", "--domain", self.domain, *ONE_LANE, "--set", f"dds={dds}", "--set", f"transport={transport}", "--set", f"security.directory={keys}",
                )
                self.assertEqual(refused.returncode, 2)
                self.assertIn("in plain text", refused.stderr)

    def test_a_daemon_that_does_not_accept_this_process_is_reported(self):
        """Like a daemon of another version: RouDi does not answer a process of a version other than its own."""
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as deaf:
            pathlib.Path(ROUDI_SOCKET).unlink(missing_ok=True)  # left by a killed daemon: if one answered, this test would not run
            deaf.bind(ROUDI_SOCKET)
            try:
                begin = time.monotonic()
                refused = self.run_program(*BY_ICEORYX, "--domain", self.domain)
                self.assertLess(time.monotonic() - begin, 3)
            finally:
                os.unlink(ROUDI_SOCKET)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("does not take this process in", refused.stderr)

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "another user needs root")
    def test_a_daemon_of_another_user_is_reported(self):
        self.start_roudi()
        as_nobody = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", *self.command(*BY_ICEORYX, "--domain", self.domain)]
        refused = subprocess.run(as_nobody, env=self.environment, capture_output=True, text=True, timeout=30)
        self.assertNotEqual(refused.returncode, 0)
        self.assertRegex(refused.stderr, "belongs to root|may not open the memory")

    @unittest.skipUnless(MAY_MOUNT, "another namespace needs root")
    def test_a_daemon_in_another_namespace_of_process_ids_is_refused(self):
        for daemon, process in (((), OWN_PROCESS_IDS), (OWN_PROCESS_IDS, ()), (OWN_PROCESS_IDS, OWN_PROCESS_IDS)):
            with self.subTest(daemon=daemon, process=process):
                roudi = self.start_roudi(within=daemon)
                refused = subprocess.run([*process, *self.command(*BY_ICEORYX, "--domain", self.domain)], env=self.environment, capture_output=True,
                                         text=True, timeout=30)
                roudi.kill()
                roudi.wait()
                self.eventually(lambda: not roudi_answers(), "the daemon is gone")
                self.assertNotEqual(refused.returncode, 0)
                self.assertIn("another namespace of process ids", refused.stderr)

    def test_pools_that_are_too_small_are_reported_with_the_size_needed(self):
        self.start_roudi((512, 1000))
        refused = self.run_program("quorient-sensor", DEMO, "--name", "sensor", "--domain", self.domain, *ONE_LANE, "--set", "transport=iceoryx")
        self.assertEqual(refused.returncode, 1, refused.stderr)
        self.assertRegex(refused.stderr, r"no free chunk for quorient/\w+.*size = \d+")

    def test_pools_that_run_out_are_reported_and_end_no_process(self):
        self.start_roudi((1024, 12), (16384, 2))
        processes = self.start_one_lane("--set", "transport=iceoryx")
        self.eventually(lambda: "samples not sent" in self.log("sensor"), "the publisher reports it")
        processes[-1].terminate()
        self.assertEqual(processes[-1].wait(timeout=10), 0)

    def test_the_death_of_roudi_is_reported_and_a_lane_comes_back_although_another_roudi_runs(self):
        pipeline = self.start_demo(*QUIET)
        children = subprocess.run(["pgrep", "-P", str(pipeline.pid), "iox-roudi"], capture_output=True, text=True).stdout.split()
        self.assertEqual(len(children), 1)
        self.assertNotIn("daemon is gone", self.log("fdi-a"))
        os.kill(int(children[0]), signal.SIGKILL)
        for name in ("fdi-a", "attitude-c", "sensor"):
            self.eventually(lambda name=name: "daemon is gone" in self.log(name), f"{name} reports it")
        self.goes_on("fdi-a")  # processes that share memory go on
        self.start_roudi()
        os.kill(self.services()["fdi-a"]["process"], signal.SIGKILL)
        self.eventually(lambda: "was asked for" in self.log("fdi-a"), "fdi-a is back, by UDP")
        self.goes_on("fdi-a")
        self.goes_on("attitude-a")
        pipeline.terminate()
        self.assertEqual(pipeline.wait(timeout=10), 0)

    def test_files_of_killed_processes_stop_no_process_and_are_cleaned_when_unused(self):
        for _ in range(2):
            pipeline = self.start_demo(*QUIET)
            cleaned = self.run_program("quorient", "clean")
            self.assertEqual(cleaned.returncode, 1)
            self.assertIn("uses it", cleaned.stderr)
            self.goes_on("fdi-a")
            self.goes_on("fdi-b")
            pipeline.kill()  # and with it all of its children
            pipeline.wait(timeout=10)
            self.eventually(lambda: not roudi_answers(), "iox-roudi is dead")
        self.assertTrue(self.our_files())
        self.eventually(lambda: self.run_program("quorient", "clean").returncode == 0, "no process uses the files")
        self.assertEqual(self.our_files(), [])
        self.assertEqual(list(self.run_directory.glob("*.heartbeat")), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
