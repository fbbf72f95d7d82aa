"""Keys in one command, refusals before anything starts, the secured demo on all vendors that can, and who may send orders."""
import os
import signal
import stat
import subprocess
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.debian import SECURED_VENDORS
from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest

DEMO = CONFIGURATIONS / "demo.yaml"
IDENTITY_EXPIRES = 60  # event code


class WithKeys(ProcessTest):
    def make_keys(self, *arguments):
        self.keys = self.run_directory / "keys"
        result = self.run_program("quorient", "keys", DEMO, "--out", self.keys, "--domain", self.domain, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def keys_verb(self, *arguments):
        return self.run_program("quorient", "keys", "--out", self.keys, *arguments)

    def secured(self, *arguments):
        return ("--set", f"security.directory={self.keys}", *arguments)

    def on_vendors_that_can(self):
        """As secured(), with the file's vendors, or the one whose processes understand each other."""
        return self.secured(*(() if len(SECURED_VENDORS) > 1 else ("--dds", *SECURED_VENDORS)))


class Keys(WithKeys):
    def test_are_made_once_and_kept(self):
        first = self.make_keys()
        names = ("sensor", "fdi-a", "fdi-b", "fdi-c", "attitude-a", "attitude-b", "attitude-c", "voter-1", "voter-2", "monitor", "operator")
        for name in names:
            self.assertEqual(stat.S_IMODE((self.keys / name / "key.pem").stat().st_mode), 0o600, name)
        self.assertNotIn("PRIVATE", first)
        key = (self.keys / "sensor/key.pem").read_text()
        self.assertEqual(self.make_keys().count("unchanged"), len(names))
        self.assertEqual((self.keys / "sensor/key.pem").read_text(), key)

    def test_are_added_renewed_and_revoked_by_name(self):
        self.make_keys()
        self.assertEqual(self.keys_verb("--add", "ground", "--role", "operator").returncode, 0)
        self.assertEqual(self.keys_verb("--add", "ground", "--role", "operator").returncode, 2)
        self.assertIn("role", self.keys_verb("--add", "other", "--role", "admin").stderr)
        key = (self.keys / "ground/key.pem").read_text()
        self.assertEqual(self.keys_verb("--renew", "ground").returncode, 0)
        self.assertNotEqual((self.keys / "ground/key.pem").read_text(), key)
        self.assertEqual(self.keys_verb("--revoke", "ground").returncode, 0)
        self.assertIn("revoked", self.keys_verb("--renew", "ground").stderr)
        refused = self.run_program("quorient", "echo", "voted", "--keys", self.keys, "--as", "ground", "--domain", self.domain)
        self.assertEqual(refused.returncode, 2)
        self.assertRegex(refused.stderr, r"ground/cyclonedds\.pem: certificate revoked")


class Refusals(WithKeys):
    """Nothing starts, and the message names the file and what to do."""

    def setUp(self):
        super().setUp()
        self.make_keys()

    def refused(self, *arguments):
        result = self.run_program("quorient", "launch", DEMO, "--domain", self.domain, *self.secured(*arguments), timeout=20)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(list(self.run_directory.glob("*.log")), [], "something was started")
        return result.stderr

    def test_of_a_missing_file(self):
        (self.keys / "fdi-b/permissions.p7s").unlink()
        (self.keys / "voter-1/key.pem").unlink()
        errors = self.refused()
        self.assertRegex(errors, r"fdi-b/permissions\.p7s: cannot be read: No such file or directory: quorient keys")
        self.assertRegex(errors, r"voter-1/key\.pem: cannot be read")

    def test_of_an_expired_certificate(self):
        self.assertEqual(self.keys_verb("--renew", "voter-2", "--days", "0.000001").returncode, 0)
        self.assertRegex(self.refused(), r"voter-2/.*\.pem: certificate has expired .*: quorient keys --out .* --renew voter-2")

    def test_of_a_key_that_others_may_read(self):
        os.chmod(self.keys / "sensor/key.pem", 0o644)
        self.assertRegex(self.refused(), r"sensor/key\.pem: others may read or write it \(mode 0644\): chmod 600")

    def test_of_keys_for_another_domain(self):
        result = self.run_program("quorient", "launch", DEMO, "--domain", self.domain + 1, *self.secured(), timeout=20)
        self.assertEqual(result.returncode, 2)
        self.assertIn(f"it is for domain {self.domain}", result.stderr)

    def test_of_another_level_than_the_keys(self):
        self.assertIn("level", self.refused("--set", "security.level=sign"))

    def test_of_shared_memory(self):
        self.assertIn("plain text", self.refused("--set", "dds=fastdds", "--set", "transport=shm", "--set", "lanes[0].dds=fastdds"))

    def test_of_a_level_without_keys(self):
        result = self.run_program("quorient", "launch", DEMO, "--set", "security.level=encrypt", timeout=20)
        self.assertEqual(result.returncode, 2)
        self.assertIn("needs the directory of the keys", result.stderr)


class SecuredDemo(WithKeys):
    """Its twin without security is processes/demo_test.py."""

    def test_isolates_the_fault_in_every_lane_and_admits_only_members(self):
        self.make_keys()
        pipeline = self.start_demo()
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs", 30)
        for vendor in SECURED_VENDORS:
            self.assertEqual(self.echo(vendor, "--keys", self.keys).returncode, 0, f"a member on {vendor} receives the attitude")
        for vendor in ("cyclonedds", "fastdds"):
            self.assertNotEqual(self.echo(vendor).returncode, 0, f"a node without a certificate on {vendor} receives nothing")
        refused = self.run_program("quorient", "readmit", "--axis", 0, "--domain", self.domain, "--keys", self.keys, "--as", "monitor")
        self.assertNotEqual(refused.returncode, 0, refused.stdout)
        self.assertIn("Not Allowed By Security", refused.stdout + refused.stderr)
        answered = self.run_program("quorient", "readmit", "--axis", 0, "--domain", self.domain, "--keys", self.keys)
        self.assertEqual(answered.returncode, 1, answered.stderr)
        self.assertEqual(answered.stdout.count("has not isolated"), 3, "an operator is answered by every detector")
        output, errors = pipeline.communicate(timeout=40)
        self.assertEqual(pipeline.returncode, 0, errors)
        self.judge(exact_json.loads(output))

    def start_demo(self):
        process = subprocess.Popen(
            self.command("quorient", "launch", DEMO, "--domain", self.domain, "--json", *self.on_vendors_that_can()), env=self.environment,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.processes.append(process)
        return process

    def echo(self, vendor, *arguments):
        return self.run_program("quorient", "echo", "voted", "--count", 5, "--json", "--timeout", 3, "--dds", vendor, "--domain", self.domain, *arguments)

    def judge(self, summary):
        for name, lane in summary["lanes"].items():
            self.assertEqual(lane["isolated"], [1], name)
            self.assertLessEqual(lane["frames_to_isolation"], 3, name)
        self.assertEqual({lane["vendor"] for lane in summary["lanes"].values()}, set(SECURED_VENDORS))
        self.assertEqual(summary["voted"]["missing"], 0)
        self.assertLess(summary["voted"]["attitude"]["final_error_rad"], 3e-6)


class Expiry(WithKeys):
    def test_is_reported_thirty_days_before_by_the_process_concerned_alone(self):
        self.make_keys()
        for name, days in (("voter-2", 29), ("attitude-b", 29), ("fdi-a", 31)):
            self.assertEqual(self.keys_verb("--renew", name, "--days", days).returncode, 0)
        pipeline = self.start("quorient", "launch", DEMO, "--domain", self.domain, "--json", "--set", "source.duration_s=60", "--set", "source.faults=[]",
                              "--set", "expect=null", *self.on_vendors_that_can())
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs", 30)
        reported = lambda: {(event["source_name"], event["text"]) for event in self.events() if event["code"] == IDENTITY_EXPIRES}  # noqa: E731
        self.eventually(lambda: len(reported()) >= 2, "both certificates are reported", 30)
        self.assertEqual({name for name, _ in reported()}, {"voter-2", "attitude-b"})
        for name, text in reported():
            self.assertIn(f"expires in 28 days: quorient keys --renew {name}", text)
        pipeline.send_signal(signal.SIGTERM)
        pipeline.wait(timeout=10)

    def events(self):
        """The events so far: each service offers its last ones to a late reader."""
        lines = self.run_program("quorient", "echo", "event", "--json", "--count", 1000, "--timeout", 3, "--domain", self.domain, "--keys", self.keys).stdout
        return [exact_json.loads(line) for line in lines.splitlines()]


class Orders(ProcessTest):
    """`commands` of the system file, without certificates."""

    def test_that_the_system_file_refuses_are_refused_with_their_sender(self):
        pipeline = self.start("quorient", "launch", DEMO, "--domain", self.domain, "--json", "--set", "source.duration_s=60",
                              "--set", "source.faults=[]", "--set", "expect=null", "--set", "commands={inject: refused, readmit: refused}")
        self.eventually(lambda: self.run_program("quorient", "health", "voter-1").returncode == 0, "the pipeline runs")
        for vendor in ("cyclonedds", "fastdds"):
            for order in (("inject", "axis=2,kind=bias,value=0.05,start=0"), ("readmit", "--axis", 2)):
                result = self.run_program("quorient", *order, "--domain", self.domain, "--dds", vendor)
                self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
                self.assertRegex(result.stdout, rf"refuses {order[0]} from 'quorient-\w+' \(unconfirmed name\): .*commands\.{order[0]}")
        pipeline.send_signal(signal.SIGTERM)
        pipeline.wait(timeout=10)


if __name__ == "__main__":
    unittest.main()
