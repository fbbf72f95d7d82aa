"""How busy this machine is: one machine that simulates four hosts may have no time left for the system under test."""


def _ticks():
    """@returns (of all kinds, idle) ticks of all processors since the machine started [proc_stat(5)]."""
    with open("/proc/stat") as lines:
        user, nice, system, idle, waiting, *interrupts = (int(word) for word in lines.readline().split()[1:9])
    return user + nice + system + idle + waiting + sum(interrupts), idle + waiting


class Load:
    def __init__(self):
        self._begin = _ticks()

    def busy(self):
        """@returns the share of all processors' time in use since this object was made, other guests of the host included."""
        total, idle = (now - then for now, then in zip(_ticks(), self._begin))
        return 1 - idle / max(total, 1)
