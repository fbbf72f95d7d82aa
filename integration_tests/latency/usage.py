"""CPU time and memory of processes while they run."""
import os
import time

PAGE_MIB = os.sysconf("SC_PAGE_SIZE") / 2**20
CPUCLOCK_SCHED = 2  # CPU-time clock of a process: MAKE_PROCESS_CPUCLOCK of the kernel's posix-timers.h


def cpu_s(process):
    """CPU time of all threads of a process, by one call: reading /proc/PID/task takes milliseconds, which would delay the processes."""
    return time.clock_gettime(~process.pid << 3 | CPUCLOCK_SCHED)


class Usage:
    """CPU and memory of processes, sampled from time to time, and interpolated to any time between two samples."""

    def __init__(self, processes):
        self.processes = processes
        self.looks = []

    def look(self):
        found = {}
        for name, process in self.processes.items():
            try:
                with open(f"/proc/{process.pid}/statm") as pages:
                    found[name] = (cpu_s(process), int(pages.read().split()[1]) * PAGE_MIB)
            except (OSError, IndexError):  # it has ended
                continue
        self.looks.append((time.monotonic(), found))

    def between(self, begin_s, end_s):
        """@returns {process: ...} from the first look to the last one in this time; empty where there are not two."""
        looks = [look for look in self.looks if begin_s <= look[0] <= end_s]
        if len(looks) < 2:
            return {}
        (first_s, first), (last_s, last) = looks[0], looks[-1]
        return {
            name: {"cpu_percent": 100 * (cpu - first[name][0]) / (last_s - first_s), "rss_mib": rss}
            for name, (cpu, rss) in last.items() if name in first
        }
