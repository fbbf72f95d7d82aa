"""Foxglove's live protocol on the monitor's port: by the protocol's own client package, and by clients that behave badly."""
import json
import os
import pathlib
import re
import subprocess
import unittest

from integration_tests.harness.monitored import MonitoredSystem
from integration_tests.harness.node_packages import node_modules
from integration_tests.harness.processes import ROOT
from integration_tests.harness.websocket import CLOSE, WebSocket

PROTOCOLS = ("foxglove.websocket.v1", "foxglove.sdk.v1")


class Viewer(MonitoredSystem):
    def connect(self, protocol=PROTOCOLS[0], **options):
        client = WebSocket(self.port, protocol, **options)
        self.addCleanup(client.close)
        return client

    def subscribed(self, channels=range(6), **options):
        client = self.connect(**options)
        client.send_json({"op": "subscribe", "subscriptions": [{"id": 100 + channel, "channelId": channel} for channel in channels]})
        return client

    def data_after(self, client):
        """The next message of a subscription: its id and its value."""
        for _ in range(1000):
            kind, payload = client.receive()
            if kind == 2:
                self.assertEqual(payload[0], 1)
                return int.from_bytes(payload[1:5], "little"), json.loads(payload[13:])
        self.fail("no data")

    def figure(self, name):
        return float(re.search(rf'^{name}{{unit="1"}} (\S+)$', self.request("GET", "/metrics")[1], re.MULTILINE)[1])

    def test_the_protocols_own_client_sees_the_attitude_the_isolated_axis_and_the_events(self):
        modules = node_modules()
        self.start_system(duration_s=30)
        for protocol in PROTOCOLS:
            if protocol == PROTOCOLS[1]:
                self.inject("axis=1,kind=bias,value=0.05,start=0")
                self.eventually(lambda: self.get("/state")["axes"][1]["state"] == "isolated", "G2 is isolated")
            client = subprocess.run(
                ["node", ROOT / "integration_tests/processes/viewer_client.cjs", f"ws://127.0.0.1:{self.port}/", protocol, "10"],
                capture_output=True, text=True, timeout=30, env=os.environ | {"NODE_PATH": str(modules)})
            self.assertEqual(client.returncode, 0, client.stderr)
            self.check(json.loads(client.stdout), protocol)

    def check(self, found, protocol):
        self.assertEqual((found["protocol"], found["status"], found["afterUnsubscribe"]), (protocol, [], 0))
        self.assertIn("four-gyro demo", found["serverInfo"]["name"])
        topics = {channel["topic"]: channel for channel in found["channels"]}
        self.assertEqual(topics["/attitude/transform"]["schemaName"], "foxglove.FrameTransform")
        turns = found["messages"]["/attitude/transform"]
        self.assertEqual(len(turns), 10)
        times = [int(turn["timestamp"]) for turn in turns]
        self.assertEqual(times, sorted(set(times)))
        for turn in turns:
            rotation = turn["message"]["rotation"]
            self.assertAlmostEqual(sum(part * part for part in rotation.values()), 1, delta=1e-9)
        self.assertLess(found["messages"]["/attitude"][-1]["message"]["error_rad"], 1e-5)
        self.assertEqual(found["messages"]["/level"][-1]["message"]["level"], "DEGRADED" if protocol == PROTOCOLS[1] else "FULL")
        isolated = {axis["name"] for axis in found["messages"]["/axes"][-1]["message"]["axes"] if axis["state"] == "isolated"}
        self.assertEqual(isolated, {"G2"} if protocol == PROTOCOLS[1] else set())

    def test_garbage_closes_that_client_alone(self):
        self.start_system(duration_s=30)
        good = self.subscribed([2])
        for garbage, kind in ((b"no JSON", 1), (b"[1, 2]", 1), (b'{"op": 7}', 1), (b'{"op": "subscribe", "subscriptions": [{"id": -1}]}', 1), (b"\x01\x02", 2),
                              (b'{"op":"subscribe"}', 1), (b"{" * 5000, 1), (b"", 0x3)):
            bad = self.connect()
            bad.send(garbage, kind)
            frames = []
            while frame := bad.receive():
                frames.append(frame)
                if frame[0] == CLOSE:
                    break
            self.assertEqual(frames[-1][0], CLOSE, garbage)
        self.assertEqual(self.data_after(good)[0], 102)
        self.eventually(lambda: self.figure("quorient_monitor_viewers") == 1, "the others are gone")

    def test_what_is_not_offered_is_said_and_the_connection_goes_on(self):
        self.start_system(duration_s=30)
        client = self.connect()
        client.send_json({"op": "getParameters", "parameterNames": []})
        client.send_json({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 99}, {"id": 1, "channelId": 2}, {"id": 1, "channelId": 3}]})
        operations, status = [], []
        while len(status) < 3:
            message = json.loads(client.receive()[1])
            operations.append(message["op"])
            status += [message["message"]] if message["op"] == "status" else []
        self.assertEqual(operations[:2], ["serverInfo", "advertise"])
        self.assertIn("getParameters", status[0])
        self.assertIn("no channel 99", status[1])
        self.assertEqual(self.data_after(client)[0], 1)

    def test_strangers_are_refused_before_the_protocol_begins(self):
        self.start_system(duration_s=20)
        self.assertEqual(self.connect("chat").status, 400)
        self.assertEqual(self.connect(origin="https://example.org").status, 403)
        accepted = self.connect(PROTOCOLS[1], origin="http://localhost:3000", cookie="c" * 8000)
        self.assertEqual((accepted.status, accepted.headers["sec-websocket-protocol"]), (101, PROTOCOLS[1]))

    def test_a_viewer_that_never_reads_loses_messages_and_costs_the_pipeline_no_frame(self):
        self.start_system(duration_s=14)
        monitor = self.monitor()
        deaf = [self.subscribed(receive_buffer=1024) for _ in range(8)]
        reading = self.subscribed([2])
        crowd = [WebSocket(self.port, PROTOCOLS[0]) for _ in range(30)]
        self.assertIn(0, {client.status for client in crowd}, "no more than 32 viewers are served")
        self.assertLessEqual(self.figure("quorient_monitor_viewers"), 32)
        self.eventually(lambda: self.figure("quorient_monitor_viewer_messages_dropped_total") > 0, "messages are dropped", timeout=12)
        for _ in range(5):
            self.assertEqual(self.data_after(reading)[0], 102)
        for client in crowd:
            client.close()
        memory_kib = int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{monitor}/status").read_text())[1])
        self.assertLess(memory_kib, 200 * 1024)
        summary = json.loads(re.search(r"^\{.*\}$", self.pipeline.communicate(timeout=60)[0], re.MULTILINE | re.DOTALL)[0])
        self.assertEqual(summary["voted"]["missing"], 0, summary)


if __name__ == "__main__":
    unittest.main(verbosity=2)
