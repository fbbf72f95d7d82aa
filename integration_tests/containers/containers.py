"""The containers of a compose file from outside: their state, their fences, and what breaks them."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys

from integration_tests.containers.scheduling import Scheduling

COMPOSE_FILE = pathlib.Path(__file__).resolve().parents[2] / "deploy/docker-compose.yml"
SYSTEM_FILE = COMPOSE_FILE.parent / "configurations/compose.yaml"
SERVICES = ["sensor", *(f"{role}-{lane}" for lane in "abc" for role in ("fdi", "attitude")), "voter-1", "voter-2"]
UID = 10001


def run(*command, check=True, timeout=120):
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=timeout)
    if check and result.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: {result.stdout}{result.stderr}")
    return result


def peers_of(system_file):
    """Options of a verb that joins from another container."""
    return [word for peer in re.findall(r"^  - ([0-9.]+)", system_file.read_text(), re.MULTILINE) for word in ("--peer", peer)]


class Containers:
    """Of one compose file: a container for each process of the system, and others."""

    def __init__(self, project, compose_file, others=()):
        self.project = project
        self._compose_file = compose_file
        self.ids = {name: self.compose("ps", "-q", name).stdout.strip() for name in (*SERVICES, *others)}
        self._scheduling = Scheduling(self.ids.values())
        self.prefer = self._scheduling.prefer

    def compose(self, *words):
        return run("docker-compose", "-p", self.project, "-f", self._compose_file, *words)

    def inspect(self, template):
        """{service: what the template makes of its container}, by one call for all."""
        names = list(self.ids)
        lines = run("docker", "inspect", "-f", template, *(self.ids[name] for name in names)).stdout.splitlines()
        return dict(zip(names, lines))

    def not_healthy(self):
        """Services whose health check, the heartbeat of fresh frames, does not say healthy, and others that have one."""
        states = self.inspect("{{if .State.Health}}{{.State.Health.Status}}{{end}}")
        return [name for name, state in states.items() if state != "healthy" and (state or name in SERVICES)]

    def processes(self):
        """{service: id of its container's first process}"""
        return {name: int(number) for name, number in self.inspect("{{.State.Pid}}").items()}

    def not_fenced(self):
        """What a process may do that it should not: [`service: what`]."""
        found = []
        for name, process in self.processes().items():
            folder = pathlib.Path(f"/proc/{process}")
            status = dict(re.findall(r"^(\w+):\s*(.*)$", (folder / "status").read_text(), re.MULTILINE))
            root = next(line.split() for line in (folder / "mountinfo").read_text().splitlines() if line.split()[4] == "/")
            limits = self._limits(name)
            found += [f"{name}: {what}" for what, wrong in {
                "not its uid": status["Uid"].split() != [str(UID)] * 4,
                "capabilities": any(int(status[kind], 16) for kind in ("CapEff", "CapPrm", "CapBnd", "CapAmb")),
                "may gain privileges": status["NoNewPrivs"] != "1",
                "no system call filter": status["Seccomp"] != "2",
                "writable root": "ro" not in root[5].split(","),
                "no memory limit": not limits["Memory"],
                "no limit of processes": not limits["PidsLimit"],
            }.items() if wrong]
        return found

    def _limits(self, name):
        return json.loads(run("docker", "inspect", "-f", "{{json .HostConfig}}", self.ids[name]).stdout)

    def kill(self, *names):
        """Kills by process id, like a crash: Docker's restart policy then restarts the container, which it does not after `docker kill`."""
        for name in names:
            os.kill(self._processes[name], signal.SIGKILL)

    def look(self):
        """Before a kill, so that it happens when it is said to: Docker takes its time to answer."""
        self._processes = self.processes()

    def pause(self, name):
        run("docker", "pause", self.ids[name])

    def go_on(self, name):
        run("docker", "unpause", self.ids[name])

    def stop(self):
        """@returns {service: exit code} of those that did not end in order."""
        self.compose("stop", *SERVICES)
        return {name: code for name, code in self.inspect("{{.State.ExitCode}}").items() if name in SERVICES and code != "0"}

    def save_logs(self, folder):
        for name, container in self.ids.items():
            with open(folder / f"{name}.log", "wb") as log:
                subprocess.run(["docker", "logs", container], stdout=log, stderr=subprocess.STDOUT, timeout=120)


class TwoNetworks(Containers):
    """Of deploy/docker-compose.yml."""

    def __init__(self, project):
        super().__init__(project, COMPOSE_FILE, ("roudi", "observer"))
        networks = json.loads(run("docker", "network", "inspect", f"{project}_network_a").stdout)
        self._bridge_a = "br-" + networks[0]["Id"][:12]

    def reaches(self, name, address):
        """Whether the address answers this container: a closed port refuses at once, a network without a route is silent."""
        probe = ("import socket, sys\ns = socket.socket()\ns.settimeout(1.5)\n"
                 "sys.exit(0 if s.connect_ex((sys.argv[1], 9)) in (0, 111) else 1)")
        return run("nsenter", "--net", "--target", self.processes()[name], sys.executable, "-c", probe, address, check=False).returncode == 0

    def inject(self, fault):
        """The truth topic shows whether the request arrived."""
        run("docker", "exec", self.ids["observer"], "quorient", "inject", fault, "--dds", "fastdds", "--interface", "any", "--domain", "42",
            "--participants-per-host", "3", *peers_of(SYSTEM_FILE), check=False)

    def cut_network_a(self):
        run("ip", "link", "set", self._bridge_a, "down")

    def heal_network_a(self):
        run("ip", "link", "set", self._bridge_a, "up")
