"""What the monitor costs: its processor time, and the pipeline's latency with and without it, in turns. A page is open all the time, and a
viewer by Foxglove's protocol that subscribes everything. A ratio is that of two runs beside each other; of the rounds the median counts.

    QUORIENT_BIN=build/release/bin python3 -m integration_tests.latency.monitor_cost --rounds 5 --seconds 10
"""
import argparse
import http.client
import statistics
import sys
import threading

from integration_tests.harness.websocket import WebSocket
from integration_tests.latency import graphs, run, table

CASES = ({"transport": "UDP, Cyclone DDS", "rate_hz": 200}, {"transport": "UDP, Cyclone DDS", "rate_hz": 1000},
         {"transport": "UDP, Cyclone DDS", "rate_hz": 1000, "axes": 24})


class Client(threading.Thread):
    """Reads what comes, as fast as it comes, and connects again until it is to end."""

    def __init__(self, port, lengths):
        super().__init__(daemon=True)
        self.port, self.lengths, self.bytes, self.ended = port, lengths, 0, False

    def run(self):
        while not self.ended:
            try:
                for length in self.lengths(self.port):
                    self.bytes += length
            except (OSError, IndexError, http.client.HTTPException):
                threading.Event().wait(0.05)


def page(port):
    """What an open page reads: the lengths of the pieces."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=2)
    connection.request("GET", "/stream")
    response = connection.getresponse()
    while data := response.read1(65536):
        yield len(data)


def viewer(port):
    """What a viewer of all channels reads."""
    socket = WebSocket(port, "foxglove.sdk.v1")
    socket.send_json({"op": "subscribe", "subscriptions": [{"id": channel, "channelId": channel} for channel in range(6)]})
    while frame := socket.receive():
        yield len(frame[1])
    socket.close()


def measure(runner, case, seconds, port, monitored):
    domain = runner.domain = runner.next_domain(1)
    file = graphs.system_file(runner.directory, case, domain, 1, seconds)
    commands = graphs.our_commands(file, case)
    if monitored:
        commands = {"monitor": [graphs.BIN / "quorient-monitor", file, "--set", f"monitor.port={port}"], **commands}
    clients = (Client(port, page), Client(port, viewer))
    if monitored:
        for client in clients:
            client.start()
    report = runner.run(commands, domain, case, seconds)
    for client in clients:
        client.ended = True
    return report, [client.bytes for client in clients]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--port", type=int, default=18080)
    parser.add_argument("--domain", type=int, default=70)
    options = parser.parse_args()
    options.limit = 60
    runner = run.Runner(options)
    print("| rate | axes | p50 without, with | ratio | p99 without, with | ratio | lost without, with | monitor: processor | memory | page's stream | viewer's |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for case in CASES:
        found = {False: [], True: []}
        usage, streamed = [], []
        for number in range(options.rounds):
            for monitored in ((False, True), (True, False))[number % 2]:
                report, size = measure(runner, case, options.seconds, options.port, monitored)
                found[monitored].append((report["hops"]["sensor_to_voted"]["p50"], report["hops"]["sensor_to_voted"]["p99"], table.lost(report)))
                if monitored and "monitor" in report["processes"]:
                    usage.append(report["processes"]["monitor"])
                    streamed.append([its / options.seconds / 1000 for its in size])
        middle = lambda monitored, place: statistics.median(values[place] for values in found[monitored])  # noqa: E731
        ratio = lambda place: statistics.median(there[place] / without[place] for without, there in zip(found[False], found[True]))  # noqa: E731
        page, viewer = (statistics.median(sizes) for sizes in zip(*streamed))
        print(f"| {case['rate_hz']} Hz | {case.get('axes', 4)} | {middle(False, 0):.0f}, {middle(True, 0):.0f} us | {ratio(0):.2f} | "
              f"{middle(False, 1):.0f}, {middle(True, 1):.0f} us | {ratio(1):.2f} | "
              f"{sum(v[2] for v in found[False])}, {sum(v[2] for v in found[True])} | {statistics.median(u['cpu_percent'] for u in usage):.1f} % of a core | "
              f"{max(u['rss_mib'] for u in usage):.0f} MiB | {page:.0f} kB/s | {viewer:.0f} kB/s |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
