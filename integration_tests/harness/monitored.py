"""A running system with a monitor, for tests of what the monitor serves."""
import http.client
import json
import socket

from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest, children_of, words_of


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def messages(response):
    """The server-sent events of a response: (kind, data)."""
    kind = None
    while line := response.readline().decode():
        if line.startswith("event: "):
            kind = line[7:].strip()
        elif line.startswith("data: "):
            yield kind, json.loads(line[6:])


class MonitoredSystem(ProcessTest):
    def start_system(self, *arguments, faults="[]", duration_s=60, rate_hz=200):
        self.port = free_port()
        self.pipeline = self.start(
            "quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--json", "--set", f"monitor.port={self.port}",
            "--set", f"source.duration_s={duration_s}", "--set", f"source.faults={faults}", "--set", "expect=null",
            "--set", f"source.rate_hz={rate_hz}", *arguments,
        )
        self.eventually(lambda: (self.get("/state") or {}).get("level") == "FULL", "the monitor shows a level of FULL")

    def request(self, method, path, body=None, headers=None, address="127.0.0.1"):
        connection = http.client.HTTPConnection(address, self.port, timeout=5)
        try:
            connection.request(method, path, body, headers or {})
            response = connection.getresponse()
            return response.status, response.read().decode()
        except OSError:
            return 0, ""
        finally:
            connection.close()

    def get(self, path):
        status, text = self.request("GET", path)
        return json.loads(text) if status == 200 else None

    def stream(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        self.addCleanup(connection.close)
        connection.request("GET", "/stream")
        return messages(connection.getresponse())

    def inject(self, spec):
        injected = self.run_program("quorient", "inject", spec, "--domain", self.domain)
        self.assertEqual(injected.returncode, 0, injected.stdout + injected.stderr)

    def children(self):
        return children_of(self.pipeline.pid)

    def monitor(self):
        """Its process; None while there is none."""
        return next((pid for pid in self.children() if any("quorient-monitor" in word for word in words_of(pid))), None)
