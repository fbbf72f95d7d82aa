"""Memory and descriptors of a run's processes, from /proc."""
import os
import pathlib

PAGE_MIB = os.sysconf("SC_PAGE_SIZE") / 2**20


def memory_and_descriptors(pipeline):
    """Resident memory [MiB], open descriptors and process id by name."""
    found = {}
    for name in pipeline.names():
        process = pipeline.process_of(name)
        try:
            pages = int(pathlib.Path(f"/proc/{process}/statm").read_text().split()[1])
            found[name] = (pages * PAGE_MIB, len(os.listdir(f"/proc/{process}/fd")), process)
        except (FileNotFoundError, ProcessLookupError):
            continue  # it has just died
    return found
