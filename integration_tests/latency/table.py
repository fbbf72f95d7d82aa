"""The latency measurement's JSON as markdown."""
import statistics

GOALS_RSS_MIB = 48


def median(values):
    values = [value for value in values if value is not None]
    return statistics.median(values) if values else None


def number(value, digits=0):
    return "-" if value is None else f"{value:.{digits}f}"


def hop(report, name, quantile):
    found = report["hops"].get(name)
    return found[quantile] if found else None


def lost(report):
    """Frames that no voter gave out, at the end of the run too."""
    return max(report["lost"], report["expected"] - report["frames"])


def rows(header, body):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return lines + ["| " + " | ".join(row) + " |" for row in body] + [""]


def name_of(case):
    parts = [case["transport"], f"{case['rate_hz']} Hz"]
    for key in ("lanes", "axes", "units"):
        if key in case:
            parts.append(f"{case[key]} {key if case[key] != 1 else key.rstrip('s')}")
    if case.get("spin"):
        parts.append("spinning")
    return ", ".join(parts)


def over_rounds(result, who, value):
    return median([value(entry[who]) for entry in result["rounds"] if who in entry])


def ratio(result, quantile):
    ratios = []
    for entry in result["rounds"]:
        if "floor" not in entry:
            continue
        ours, floor = (hop(entry[who], "sensor_to_voted", quantile) for who in ("ours", "floor"))
        if ours and floor:
            ratios.append(ours / floor)
    return median(ratios)


def usage(report, key, combine):
    values = [process[key] for process in report["processes"].values()]
    return combine(values) if values else None


def ping_section(results):
    lines = ["## One hop", "", "Half a round trip of one SensorFrame between two processes at 1 kHz, four paths in turns of 20, medians of the rounds [us].", ""]
    body = []
    for result in results:
        value = lambda path, q: median([entry[path].get(q) for entry in result["rounds"]])  # noqa: E731
        of = lambda q: median([entry["bus"][q] / entry["vendor"][q] for entry in result["rounds"] if "p50" in entry["bus"] and "p50" in entry["vendor"]])  # noqa: E731
        cells = [f"{number(value(path, 'p50'))} / {number(value(path, 'p99'))}" for path in ("bus", "vendor", "futex", "udp socket")]
        body.append([f"{result['dds']}, {result['transport']}", *cells, number(of("p50"), 3), number(of("p99"), 2), number(value("bus", "lost"))])
    return lines + rows(["path", "bus p50 / p99", "vendor's API", "futex", "UDP socket", "bus / vendor p50", "p99", "lost"], body)


def pipeline_rows(results):
    body = []
    for result in results:
        for who in ("ours", "floor"):
            if who not in result["rounds"][0]:
                continue
            value = lambda quantile: number(over_rounds(result, who, lambda r: hop(r, "sensor_to_voted", quantile)))  # noqa: E731
            counts = [number(over_rounds(result, who, count)) for count in (lost, lambda r: r["duplicates"], lambda r: r["late"])]
            body.append([
                name_of(result["case"]), who, *map(value, ("p50", "p90", "p99", "p99.9", "max")), *counts,
                number(over_rounds(result, who, lambda r: usage(r, "cpu_percent", sum))),
                number(over_rounds(result, who, lambda r: usage(r, "rss_mib", max)), 1),
                number(ratio(result, "p50"), 2) if who == "ours" else "",
            ])
    return rows(["case", "graph", "p50", "p90", "p99", "p99.9", "max", "lost", "duplicate", "late", "CPU [%]", "largest RSS [MiB]", "p50 ours / floor"], body)


HOPS = ("sensor_to_detector", "detector", "detector_to_integrator", "integrator", "integrator_to_voter", "voter", "sensor_to_verdict", "sensor_to_attitude", "sensor_to_voted")


def hop_rows(results):
    body = []
    for result in results:
        for name in HOPS:
            values = [over_rounds(result, "ours", lambda r, q=q: hop(r, name, q)) for q in ("p50", "p90", "p99", "p99.9", "max")]
            body.append([name_of(result["case"]) if name == HOPS[0] else "", name.replace("_", " "), *(number(value, 1) for value in values)])
    return rows(["case", "hop", "p50", "p90", "p99", "p99.9", "max"], body)


def process_rows(result):
    names = result["rounds"][0]["ours"]["processes"]
    body = []
    for name in names:
        of = lambda who, key: number(over_rounds(result, who, lambda r: r["processes"].get(name, {}).get(key)), 1)  # noqa: E731
        body.append([name, of("ours", "cpu_percent"), of("ours", "rss_mib"), of("floor", "cpu_percent"), of("floor", "rss_mib")])
    return rows(["process", "CPU [%]", "RSS [MiB]", "floor's CPU [%]", "floor's RSS [MiB]"], body)


def transports_section(results):
    lines = ["## Pipelines by transport", "", "Sensor stamp to voted [us]: one sensor, three lanes, two voters, one probe; `floor`: the same graph with empty algorithms on the vendor's API.", ""]
    lines += pipeline_rows(results) + ["### Hop by hop, ours [us]", ""] + hop_rows(results)
    for result in results:
        lines += [f"### Processes: {name_of(result['case'])}", ""] + process_rows(result)
    return lines


def sustained_section(results):
    minute = results["minute"]
    report = minute["report"]
    lines = ["## Sustained", "", f"{minute['seconds']:.0f} s at {minute['case']['rate_hz']} Hz, {minute['case']['transport']}, three lanes, two voters: "
             f"{lost(report)} of {report['expected']} frames lost, {report['late']} late, p50 {number(hop(report, 'sensor_to_voted', 'p50'))} us.", ""]
    body = [[str(step["rate_hz"]), str(step["report"]["expected"]), str(lost(step["report"])), number(hop(step["report"], "sensor_to_voted", "p50")),
             number(usage(step["report"], "cpu_percent", sum))] for step in results["ladder"]]
    lines += rows(["rate [Hz]", "frames", "lost", "p50 [us]", "CPU [%]"], body)
    held = [step["rate_hz"] for step in results["ladder"] if lost(step["report"]) == 0]
    return lines + [f"Highest rate without a lost frame: {max(held) if held else minute['case']['rate_hz'] if lost(report) == 0 else 'none of these'} Hz.", ""]


def growth_section(results):
    return ["## Growth", "", "Sensor stamp to voted [us], one round each.", ""] + pipeline_rows(results) + hop_rows(results)


def spinning_section(results):
    return ["## Blocking and spinning", "", "One lane, one voter: four processes and the probe; all of them spin.", ""] + pipeline_rows(results)


SECTIONS = {"hops": ping_section, "transports": transports_section, "sustained": sustained_section, "growth": growth_section, "spinning": spinning_section}


def markdown(results):
    machine = results["machine"]
    versions = ", ".join(f"{name} {value}" for name, value in machine["versions"].items())
    lines = [
        "# Latency", "", f"Made by `{machine['command']}` on {machine['date']}: {machine['processor']}, {machine['cores']} cores, Linux {machine['kernel']}, "
        f"{versions}; {machine['rounds']} rounds of {machine['seconds']} s each, nice {machine['nice']}, load {machine['load_before'][0]:.1f} at the start.", "",
    ]
    for name, section in SECTIONS.items():
        if name in results:
            lines += section(results[name])
    return "\n".join(lines)
