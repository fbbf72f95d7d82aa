"""Five jobs of a new user, as README, docs and --help describe them, with every message that appears, as a Markdown page.

usage: QUORIENT_BIN=build/release/bin python3 -m integration_tests.docs.first_jobs > integration_tests/results/first_jobs.md
"""
import contextlib
import math
import os
import pathlib
import platform
import random
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from integration_tests.harness.foreign import INTEROP, build, example
from integration_tests.harness.processes import BIN, CONFIGURATIONS

MOST_LINES = 45  # of one command's output; what is left out is counted
DEADLINE_S = 120


class Page:
    """Runs commands as a user types them, in a folder of its own, and prints them with what they answer."""

    def __init__(self, folder):
        self.folder = folder
        self.environment = dict(os.environ, PATH=f"{BIN.resolve()}:{os.environ['PATH']}", QUORIENT_RUN_DIR=str(folder / "run"))
        self.started = []

    def say(self, text):
        print(text + "\n", flush=True)

    def cleaned(self, text):
        """Without the folders of this machine."""
        return text.replace(str(self.folder) + "/", "").replace(str(BIN.resolve()) + "/", "").replace(str(self.folder), ".")

    def answer(self, text):
        for line in self.cut(self.cleaned(text).rstrip().splitlines()):
            print(line)

    def cut(self, lines):
        if len(lines) <= MOST_LINES:
            return lines
        return lines[: MOST_LINES - 10] + [f"… {len(lines) - MOST_LINES + 1} lines …"] + lines[-9:]

    def show(self, *commands, timeout=DEADLINE_S):
        """One block of commands, each with its output; an exit code other than 0 is named."""
        print("```")
        for command in commands:
            print(f"$ {command}", flush=True)
            done = subprocess.run(["sh", "-c", command], cwd=self.folder, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  stdin=subprocess.DEVNULL, text=True, timeout=timeout)
            self.answer(done.stdout)
            if done.returncode != 0:
                print(f"[exit code {done.returncode}]")
        print("```\n", flush=True)

    @contextlib.contextmanager
    def beside(self, command, shown=None):
        """A program that runs in another window meanwhile; its output follows at the end."""
        log = self.folder / f"window-{len(self.started)}.txt"
        with log.open("w") as output:
            process = subprocess.Popen(shlex.split(command), cwd=self.folder, env=self.environment, stdout=output, stderr=subprocess.STDOUT,
                                       stdin=subprocess.DEVNULL)
        self.started.append(process)
        self.say(f"In another window: `{shown or command}`")
        try:
            yield process
        finally:
            closed = process.poll() is None  # the user closes that window
            if closed:
                process.terminate()
            process.wait(10)
            self.say("That window then shows:")
            print("```")
            self.answer(log.read_text())
            if process.returncode and not closed:
                print(f"[exit code {process.returncode}]")
            print("```\n", flush=True)

    def until(self, command):
        """Waits, unseen, until a command succeeds."""
        deadline = time.monotonic() + DEADLINE_S
        while subprocess.run(["sh", "-c", command], cwd=self.folder, env=self.environment, capture_output=True, check=False).returncode != 0:
            if time.monotonic() > deadline or all(process.poll() is not None for process in self.started):
                raise TimeoutError(f"{command} did not succeed while the other windows ran")
            time.sleep(0.1)

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def kill(self, launch, name):
        """Ends one process of a running launch, as a crash would."""
        children = pathlib.Path(f"/proc/{launch.pid}/task/{launch.pid}/children").read_text().split()
        for child in children:
            if f"--name\0{name}\0" in pathlib.Path(f"/proc/{child}/cmdline").read_text():
                os.kill(int(child), signal.SIGKILL)
                return self.say(f"Somebody kills `{name}` (SIGKILL).")
        raise ProcessLookupError(name)

    def stop(self):
        for process in self.started:
            if process.poll() is None:
                process.kill()
                process.wait()


def three_imus(seconds=60, rate_hz=100, seed=1):
    """A table as people write it: time and three IMUs in deg/s, each with its own offset and noise. From 30 s on imu2 y reads 12 deg/s too much."""
    chance = random.Random(seed)
    offsets = [[chance.gauss(0, 0.5) for _ in range(3)] for _ in range(3)]
    rows = ["time," + ",".join(f"imu{i}_{axis}" for i in (1, 2, 3) for axis in "xyz")]
    for k in range(seconds * rate_hz):
        t = k / rate_hz
        swing = min(1, max(0, t - 8)) * 40
        body = [swing * math.sin(0.9 * t), swing * math.sin(1.3 * t + 1), swing * math.sin(0.7 * t + 2)]
        values = [body[axis] + offsets[imu][axis] + chance.gauss(0, 0.05) for imu in range(3) for axis in range(3)]
        values[4] += 12 if t >= 30 else 0
        rows.append(f"{t:.2f}," + ",".join(f"{value:.4f}" for value in values))
    return "\n".join(rows) + "\n"


def job_csv(page):
    page.say("## 1. A CSV of three IMUs\n\nThe table `flight.csv` has a time column and three IMUs at 100 Hz. After 30 s one of them reads 12 deg/s too much. "
             "The user knows `quorient diagnose` from the README.")
    page.write("flight.csv", three_imus())
    page.show("head -3 flight.csv", "quorient diagnose flight.csv")
    page.say("The table does not state the unit of its rates, and the message names the option for it.")
    page.show("quorient diagnose flight.csv --unit deg/s",
              "quorient diagnose flight.csv --unit deg/s --html flight.html > /dev/null && ls flight.html", "quorient diagnose flight.csv --unit deg/s --check > /dev/null")
    page.say("What would the pipeline have made of it? `quorient replay --help` asks for a system file; `flight.yaml` has three instruments.")
    shutil.copy(CONFIGURATIONS / "flight.yaml", page.folder)
    page.show("quorient replay flight.csv", "quorient replay flight.cvs --system flight.yaml", "quorient replay flight.csv --system flight.yaml",
              "quorient replay flight.csv --system flight.yaml --unit deg/s")


def job_own_hardware(page):
    page.say("## 2. Own hardware, through the example publisher\n\nAs [your own sensors](../../docs/your-own-sensors.md) describes it; `quorient simulate` stands for the hardware.")
    shutil.copy(CONFIGURATIONS / "demo.yaml", page.folder / "my_system.yaml")
    shutil.copy(example("publisher_cyclonedds"), page.folder / "publisher")
    page.write("axes.csv", "0.81649658,0,0.57735027,0,4.848e-7\n0,0.81649658,0.57735027,0,4.848e-7\n-0.81649658,0,0.57735027,0,4.848e-7\n0,-0.81649658,0.57735027,0,4.848e-7\n")
    page.show("quorient check my_system.yaml > /dev/null && echo the file is good",
              "quorient simulate coning --layout cone-4 --interval 0.005 --duration 15 --quantum 4.848e-7 --quantize carry --fault axis=1,kind=scale,value=0.8,start=8 > recording.csv")
    with page.beside("quorient launch my_system.yaml --without sensor --duration 25 --set expect=null"):
        page.until("quorient health voter-1; [ $? -le 1 ] && quorient status --seconds 0.5 | grep -q voter-1")
        page.say("Before the publisher runs:")
        page.show("quorient echo frame --count 1 --timeout 1", "quorient status --seconds 1")
        with page.beside("./publisher 42 axes.csv recording.csv"):
            page.show("quorient echo frame --count 1 --timeout 5 | head -12", "quorient status", "quorient health voter-1")
            time.sleep(8)
            page.show("quorient status | head -3")


THREE_IMUS = """name: a robot's three IMUs
domain: 42
unit: {id: 1, name: robot, initial_attitude: [1, 0, 0, 0]}
source:
  kind: ros2_imu
  rate_hz: 100
  skew_s: 0.1
  noise_rad: 1.0e-6
  imus:
    - {topic: /imu_1/data, name: front}
    - {topic: /imu_2/data, name: middle, rotation: [0.5, 0.5, 0.5, 0.5]}
    - {topic: /imu_3/data, name: rear, rotation: [0, 0, 0, 1]}
lanes:
  - {name: a, detector: {method: subset, instruments: true, max_faults: 1, pfa: 1.0e-9}}
  - {name: b, detector: {method: subset, instruments: true, max_faults: 1, pfa: 1.0e-9}}
  - {name: c, detector: {method: subset, instruments: true, max_faults: 1, pfa: 1.0e-9}}
voters: [{name: voter-1}, {name: voter-2}]
voting: {patience: 1, silence_intervals: 10}
"""


def job_ros2(page):
    page.say("## 3. Three ROS 2 IMUs\n\nThe system file, from the keys of [system-file.md](../../docs/system-file.md). A plain DDS node stands for the drivers.")
    page.write("robot.yaml", THREE_IMUS)
    shutil.copy(build(INTEROP / "ros2_node_cyclonedds", "ros2_node_cyclonedds"), page.folder / "drivers")
    page.show("cat robot.yaml", "quorient check robot.yaml > /dev/null && echo the file is good")
    page.say("First the drivers do not run:")
    page.show("quorient launch robot.yaml --duration 8")
    page.say("Then they do:")
    with page.beside("./drivers 42 robot", "the three drivers"):
        with page.beside("quorient launch robot.yaml --duration 20"):
            page.until("quorient health voter-1")
            page.show("quorient status", "quorient echo voted --count 1 --timeout 5 | head -8")
            time.sleep(3)
    page.show("quorient launch robot.yaml --set source.imus.front.topic=/imu_9/data --duration 1 --set lanes.d.name=e")


def job_layouts(page):
    page.say("## 4. Comparing two layouts\n\nSix gyros: on a cone, or as a dodecahedron?")
    page.show("quorient layout | grep -i -e cone -e dodeca", "quorient layout cone-6 --design | tail -19", "quorient layout dodecahedron --design | tail -19")
    page.show("quorient layout dodecahedrom", "quorient design --axes 6 --explain", "quorient design --axes 5 --isolable 2")


def job_demo(page):
    page.say("## 5. Watching and disturbing the demo\n\nThe demo for two minutes, without its own fault.")
    shutil.copy(CONFIGURATIONS / "demo.yaml", page.folder)
    with page.beside("quorient launch demo.yaml --set source.duration_s=120 --set source.faults=[] --set expect=null --duration 45") as launch:
        page.until("quorient health voter-1")
        page.show("quorient status", "quorient inject axis=G2,kind=scale,value=0.8", "sleep 1; quorient status | head -1")
        page.show("quorient readmit --axis 1", "quorient inject --clear", "sleep 1; quorient readmit --axis G2", "sleep 1; quorient status | head -1")
        page.show("quorient inject axis=G2,kind=tired", "quorient inject axis=G9,kind=zero", "quorient inject axis=9,kind=zero", "quorient status --wach", "quorient injekt axis=1,kind=zero", "quorient status --unit 7 --seconds 1",
                  "quorient status --domain 43 --seconds 1")
        page.show("quorient launch demo.yaml --duration 5", "quorient record flight.csv --duration 2", "quorient record flight.csv --duration 2", "quorient health voter-1", "quorient health voter-3",
                  "quorient health voter-1 --domain 43")
        page.kill(launch, "voter-1")
        page.show("sleep 2; quorient status | head -1", "quorient health voter-1")
    page.show("quorient replay flight.csv --system demo.yaml --set expect=null", "quorient status --seconds 1", "quorient clean --dry-run; echo")


JOBS = {"csv": job_csv, "own-hardware": job_own_hardware, "ros2": job_ros2, "layouts": job_layouts, "demo": job_demo}


def main(wanted):
    unknown = set(wanted) - set(JOBS)
    if unknown:
        sys.exit(f"unknown job {', '.join(sorted(unknown))}; known are {', '.join(JOBS)}")
    print("# Five jobs of a new user\n")
    print(f"Made by `python3 -m integration_tests.docs.first_jobs`, {platform.machine()}, {os.cpu_count()} processors. Every command stands as typed, "
          "with all that it printed to both outputs; long outputs are cut in their middle. Nothing but README, docs and `--help` was used.\n")
    for name in wanted or JOBS:
        folder = pathlib.Path(tempfile.mkdtemp(prefix="quorient-jobs-"))
        page = Page(folder)
        try:
            JOBS[name](page)
        finally:
            page.stop()
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main(sys.argv[1:])
