"""Gives the containers real-time priority: a busy machine must not look like a fault.

`priority` of the system file and deploy/docker-compose.rt.yml do the same where the Docker daemon permits it. A container with that override
does not start where it is not permitted, so the test sets the priority from outside. Where the kernel refuses, the run goes on without.
"""
import os
import pathlib
import re

GROUPS = pathlib.Path(os.environ.get("QUORIENT_CONTROL_GROUPS", "/sys/fs/cgroup"))
PRIORITY = 10
SERVICES = ("quorient-", "iox-roudi")  # not what a health check starts
RUNTIME_US = 900_000  # per second and processor: real-time group scheduling, where the kernel has it


class Scheduling:
    def __init__(self, containers):
        """@param containers their full ids"""
        self._containers = set(containers)
        self._done = set()
        self._group = None
        self.refused = ""

    def prefer(self):
        """To be called again when a container may have been restarted."""
        for process in filter(str.isdigit, os.listdir("/proc")):
            try:
                self._prefer(pathlib.Path("/proc") / process)
            except (FileNotFoundError, ProcessLookupError):
                pass  # it has ended

    def _prefer(self, process):
        groups = (process / "cgroup").read_text()
        if not self._containers.intersection(re.findall(r"[0-9a-f]{64}", groups)):
            return
        if not self._group:
            self._open(groups)
        if not (process / "comm").read_text().startswith(SERVICES):
            return
        for thread in map(int, os.listdir(process / "task")):
            if thread not in self._done:
                self._done.add(thread)
                self._raise(thread)

    def _open(self, groups):
        """The group of all containers, where it is our own daemon's."""
        found = re.search(r"/(quorient-\d+)/", groups)
        self._group = found[1] if found else "none"
        self._write("cpu/{}/cpu.rt_runtime_us", str(RUNTIME_US))

    def _write(self, file, value):
        path = GROUPS / file.format(self._group)
        try:
            if path.exists():
                path.write_text(value)
        except OSError as problem:
            self.refused = str(problem)

    def _raise(self, thread):
        # Real-time group scheduling gives each container none of its own; all share that of the group above them.
        self._write("cpu/{}/tasks", str(thread))
        try:
            os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(PRIORITY))
        except PermissionError as problem:
            self.refused = str(problem)
