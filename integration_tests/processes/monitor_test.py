"""The monitor of a running system: what it serves, and that no other process notices whether it is there."""
import contextlib
import json
import pathlib
import random
import re
import shutil
import socket
import subprocess
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.processes import ROOT
from integration_tests.harness.monitored import MonitoredSystem


class Monitor(MonitoredSystem):
    def test_a_failed_gyro_turns_isolated_on_the_stream_and_only_that_one(self):
        self.start_system()
        stream = self.stream()
        states, events = {}, []
        self.inject("axis=2,kind=bias,value=0.05,start=0")
        for count, (kind, data) in enumerate(stream):
            if kind in ("events", "all_events"):
                events += data
            else:
                states = {axis["name"]: axis["state"] for axis in data["axes"]}
            if states.get("G3") == "isolated" and any(event["code"] == "ISOLATED" for event in events):
                break
            self.assertLess(count, 200, f"not isolated on the stream: {states}")
        self.assertEqual(states, {"G1": "healthy", "G2": "healthy", "G3": "isolated", "G4": "healthy"})
        isolated = next(event for event in events if event["code"] == "ISOLATED")
        injected = next(event for event in events if event["code"] == "FAULT_INJECTED")
        self.assertEqual(isolated["axes"], [2])
        self.assertLess(isolated["wall_time_ms"] - injected["wall_time_ms"], 1000)
        metrics = self.request("GET", "/metrics")[1]
        self.assertRegex(metrics, r'quorient_isolations_total\{unit="1",axis="G3",lane="a"\} 1\n')
        self.assertRegex(metrics, r'quorient_isolations_total\{unit="1",axis="G2",lane="a"\} 0\n')
        self.check_by_promtool(metrics)

        self.check_figures_exist(metrics)

    def check_figures_exist(self, metrics):
        """What rules and dashboard ask for is really exported."""
        for file in ("alerts.yaml", "dashboard.json"):
            asked = set(re.findall(r"quorient_[a-z_]+", (ROOT / "deploy/monitoring" / file).read_text()))
            self.assertGreater(len(asked), 5, file)
            self.assertEqual({name for name in asked if not re.search(rf"^{name}[{{ ]", metrics, re.MULTILINE)}, set(), file)

    def check_by_promtool(self, metrics):
        if shutil.which("promtool"):
            checked = subprocess.run(["promtool", "check", "metrics"], input=metrics, capture_output=True, text=True, timeout=30)
            self.assertEqual((checked.returncode, checked.stderr), (0, ""))

    def test_without_a_fault_nothing_is_shown(self):
        self.start_system()
        ticks = 0
        for kind, data in self.stream():
            if kind in ("events", "all_events"):
                alarming = [event for event in data if event["code"] in ("ISOLATED", "SUSPECT", "AMBIGUOUS", "BLIND", "LEFT_OUT")]
                self.assertEqual(alarming, [])
                continue
            self.assertEqual({axis["state"] for axis in data["axes"]}, {"healthy"})
            self.assertEqual(data["level"], "FULL")
            ticks += 1
            if ticks == 15:
                break
        self.assertEqual(self.request("GET", "/healthz")[0], 200)
        self.assertEqual(self.request("POST", "/order", '{"action":"clear"}', {"Content-Type": "application/json"})[0], 403)
        state = self.get("/state")
        self.assertLess(state["attitude"]["error_rad"], 1e-5)
        self.assertEqual({service["state"] for service in state["services"]}, {"RUNNING"})

    def test_an_order_from_the_page_breaks_an_axis_where_orders_are_allowed(self):
        self.start_system("--set", "monitor.allow_orders=true")
        order = json.dumps({"action": "inject", "fault": "axis=1,kind=bias,value=0.05,start=0"})
        self.assertEqual(self.request("POST", "/order", order, {"Content-Type": "application/json"})[0], 202)
        self.eventually(lambda: self.get("/state")["axes"][1]["state"] == "isolated", "G2 is isolated")

    def test_bad_clients_and_a_killed_monitor_cost_the_pipeline_no_frame(self):
        self.start_system(duration_s=9)
        process = self.monitor()
        before_kib = self.memory_kib(process)
        deaf = [self.connection(b"GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n") for _ in range(100)]
        endless = [self.connection(b"GET /state HTTP/1.1\r\nX: ") for _ in range(28)]
        many = [self.connection(bytes(random.Random(seed).randrange(256) for _ in range(200))) for seed in range(2000)]
        for client in [*endless, *many]:
            client.close()
        self.eventually(lambda: self.request("GET", "/healthz")[0] == 200, "the monitor serves again")
        self.assertLess(self.memory_kib(process) - before_kib, 50 * 1024)
        for client in deaf:
            client.close()
        subprocess.run(["kill", "-9", str(process)], check=True)
        self.eventually(lambda: self.monitor() not in (None, process) and (self.get("/state") or {}).get("level"), "another monitor serves")
        summary = self.summary()
        self.assertEqual(summary["voted"]["missing"], 0, summary)

    def connection(self, first_bytes):
        client = socket.create_connection(("127.0.0.1", self.port), timeout=5)
        with contextlib.suppress(OSError):  # it may be closed at once
            client.sendall(first_bytes)
        return client

    def memory_kib(self, process):
        return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{process}/status").read_text())[1])

    def summary(self):
        return exact_json.loads(re.search(r"^\{.*\}$", self.pipeline.communicate(timeout=60)[0], re.MULTILINE | re.DOTALL)[0])


if __name__ == "__main__":
    unittest.main(verbosity=2)
