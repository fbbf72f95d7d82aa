"""The graphs of processes that are measured, as commands: ours, ours composed, and the floors."""
import json
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("QUORIENT_BIN", ROOT / "build/release/bin"))

# Name -> the keys of the system file for sensor, lanes and voters in turn, and the floor's arguments.
TRANSPORTS = {
    "UDP, Cyclone DDS": ([{"dds": "cyclonedds"}], ["--dds", "cyclonedds"]),
    "UDP, Fast DDS": ([{"dds": "fastdds"}], ["--dds", "fastdds"]),
    "shared memory, Fast DDS": ([{"dds": "fastdds", "transport": "shm"}], ["--dds", "fastdds", "--shared-memory"]),
    "iceoryx, Cyclone DDS": ([{"dds": "cyclonedds", "transport": "iceoryx"}], ["--dds", "cyclonedds", "--shared-memory"]),
    "mixed": ([{"dds": "cyclonedds", "transport": "iceoryx"}, {"dds": "fastdds", "transport": "shm"}, {"dds": "cyclonedds"}], None),
}
LAYOUTS = {4: "cone-4", 6: "cone-6", 8: "octahedron-8", 24: "triads-8"}


def system_file(directory, case, domain, unit, seconds):
    keys = TRANSPORTS[case["transport"]][0]
    at = lambda place: dict(keys[place % len(keys)])  # noqa: E731
    # A core for every process is more than this machine has: only a lane's own processes spin.
    common = {"stamps": True, "spin": case.get("spin", False)}
    axes = case.get("axes", 4)
    method = {"method": "vector"} if axes == 4 else {}  # the default of the layout
    system = {
        "name": "latency", "domain": domain, "interface": "lo", **common,
        "unit": {"id": unit, "layout": LAYOUTS[axes]},
        "sensor": at(0),
        "source": {
            "motion": {"kind": "coning", "k2": 0.084, "k3": 0.05}, "rate_hz": case["rate_hz"], "duration_s": seconds,
            "quantum_rad": 0.4848e-6, "quantize": "carry",
        },
        "lanes": [{"name": f"l{i}", "detector": method, **at(i)} for i in range(case.get("lanes", 3))],
        "voters": [{"name": f"voter-{i + 1}", **at(i)} for i in range(case.get("voters", 2))],
    }
    path = directory / f"system-{unit}.yaml"
    path.write_text(json.dumps(system))  # JSON is YAML
    return path


def our_commands(file, case, prefix=""):
    names = [("quorient-voter", f"voter-{i + 1}") for i in range(case.get("voters", 2))]
    for i in range(case.get("lanes", 3)):
        names += [("quorient-attitude", f"attitude-l{i}"), ("quorient-fdi", f"fdi-l{i}")]
    return {prefix + name: [BIN / program, file, "--name", name] for program, name in [*names, ("quorient-sensor", "sensor")]}


def lanes_composed(file, case):
    """Detector and integrator of each lane in one process."""
    commands = our_commands(file, case)
    for i in range(case.get("lanes", 3)):
        names = [f"fdi-l{i}", f"attitude-l{i}"]
        for name in names:
            del commands[name]
        commands = {"+".join(names): [BIN / "quorient-run", file, *names], **commands}
    return commands


def all_but_sensor_composed(file, case):
    commands = our_commands(file, case)
    names = [name for name in commands if name != "sensor"]
    return {"the rest": [BIN / "quorient-run", file, *names], "sensor": commands["sensor"]}


def floor_commands(case, domain, seconds):
    base = [BIN / "quorient-latency-graph"]
    lanes, voters = case.get("lanes", 3), case.get("voters", 2)
    common = [*TRANSPORTS[case["transport"]][1], "--domain", domain, "--lanes", lanes, "--voters", voters]
    common += ["--spin"] if case.get("spin") else []
    commands = {f"voter-{i + 1}": [*base, "voter", "--number", i + 1, *common] for i in range(voters)}
    for i in range(lanes):
        commands[f"attitude-l{i}"] = [*base, "integrator", "--number", i, *common]
        commands[f"fdi-l{i}"] = [*base, "detector", "--number", i, *common]
    commands["sensor"] = [*base, "sensor", *common, "--rate", case["rate_hz"], "--duration", seconds]
    return commands


def probe_command(case, domain, skip):
    reads_by = TRANSPORTS[case["transport"]][0][0]
    return [BIN / "quorient-latency-probe", "--dds", reads_by["dds"], "--transport", reads_by.get("transport", "udp"), "--domain", domain, "--skip", skip,
            "--interval", 1 / case["rate_hz"]]
