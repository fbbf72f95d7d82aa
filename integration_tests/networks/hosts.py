"""Hosts that are network namespaces, joined by bridges in a namespace of their own. Nothing touches the machine's own network."""
import contextlib
import os
import subprocess

from integration_tests.harness.processes import BIN

SWITCH = "switch"


def ip(*words):
    subprocess.run(["ip", *map(str, words)], check=True, capture_output=True, text=True, timeout=30)


def not_permitted():
    """@returns why namespaces, links and packet filters cannot be made here; None where they can."""
    try:
        with Hosts({"a": ("x",)}) as hosts:
            hosts.lose("a", 0.5)
    except FileNotFoundError as problem:
        return f"{problem.filename} is not installed"
    except subprocess.CalledProcessError as problem:
        return f"`{' '.join(problem.cmd)}`: {problem.stderr.strip()}"
    except OSError as problem:
        return str(problem)
    return None


class Hosts:
    """Namespaces by host, one interface per network: eth0, eth1, ... in the order in which a host lists its networks.

    Addresses are those of the range for tests of networks [RFC 2544]: 198.18.<network>.<host>. Names carry this process's id.
    Use as a context: whatever happens inside, every namespace and with it every link, bridge and rule is removed."""

    def __init__(self, networks_of_host, impaired=None):
        """@param impaired {host: options of bad_cable}: this host's first link."""
        self.networks_of_host = networks_of_host
        self._impaired = impaired or {}
        self._bad_cables = {}
        self._networks = sorted({network for networks in networks_of_host.values() for network in networks})
        self._cleanup = contextlib.ExitStack()

    def __enter__(self):
        try:
            self._build()
        except BaseException:
            self._cleanup.close()
            raise
        return self

    def __exit__(self, *_):
        self._cleanup.close()

    def namespace(self, host):
        return f"qn{os.getpid()}-{host}"

    def inside(self, host):
        """The prefix of a command that runs on this host."""
        return ["ip", "netns", "exec", self.namespace(host)]

    def address(self, host, network):
        return f"198.18.{self._networks.index(network) + 1}.{list(self.networks_of_host).index(host) + 1}"

    def addresses(self, networks=None):
        """The addresses of all hosts on these networks."""
        return [self.address(host, network) for host, own in self.networks_of_host.items() for network in own
                if networks is None or network in networks]

    def unplug(self, host):
        """The first link of a host: no carrier at either end."""
        ip("-n", self.namespace(SWITCH), "link", "set", self._port(host, 0), "down")

    def plug(self, host):
        ip("-n", self.namespace(SWITCH), "link", "set", self._port(host, 0), "up")

    def cut(self, network):
        """A network forwards nothing; its hosts' interfaces stay up."""
        ip("-n", self.namespace(SWITCH), "link", "set", f"net-{network}", "down")

    def heal(self, network):
        ip("-n", self.namespace(SWITCH), "link", "set", f"net-{network}", "up")

    def lose(self, host, probability):
        """Every packet that comes in from a network is dropped with this probability."""
        self._filter(host, "-A", "INPUT", "!", "-i", "lo", "-m", "statistic", "--mode", "random", "--probability", probability, "-j", "DROP")

    def lose_nothing(self, host):
        self._filter(host, "-F", "INPUT")

    def impair(self, word):
        """@param word `bad` or `good`, for every bad cable."""
        for cable in self._bad_cables.values():
            cable.stdin.write(word[0])
            cable.stdin.flush()

    def _filter(self, host, *words):
        subprocess.run([*self.inside(host), "iptables", *map(str, words)], check=True, capture_output=True, text=True, timeout=30)

    @staticmethod
    def _port(host, number):
        return f"{host}-{number}"

    def _build(self):
        self._add_namespace(SWITCH)
        for network in self._networks:
            ip("-n", self.namespace(SWITCH), "link", "add", f"net-{network}", "type", "bridge", "mcast_snooping", 0)
            self.heal(network)
        for host, networks in self.networks_of_host.items():
            self._add_namespace(host)
            for number, network in enumerate(networks):
                self._connect(host, number, network)

    def _add_namespace(self, name):
        ip("netns", "add", self.namespace(name))
        self._cleanup.callback(subprocess.run, ["ip", "netns", "del", self.namespace(name)], timeout=30, check=False)
        ip("-n", self.namespace(name), "link", "set", "lo", "up")

    def _connect(self, host, number, network):
        port, interface = self._port(host, number), f"eth{number}"
        if number == 0 and host in self._impaired:
            self._lay_bad_cable(host, port, interface)
        else:
            ip("-n", self.namespace(SWITCH), "link", "add", port, "type", "veth", "peer", "name", interface, "netns", self.namespace(host))
        ip("-n", self.namespace(SWITCH), "link", "set", port, "master", f"net-{network}", "up")
        ip("-n", self.namespace(host), "addr", "add", f"{self.address(host, network)}/24", "dev", interface)
        ip("-n", self.namespace(host), "link", "set", interface, "up")

    def _lay_bad_cable(self, host, port, interface):
        """Both ends are made in the switch's namespace; the host's end moves and stays open in the process."""
        cable = subprocess.Popen([*self.inside(SWITCH), str(BIN / "quorient_bad_cable"), port, f"{port}-far", *self._impaired[host]],
                                 stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self._bad_cables[host] = cable
        self._cleanup.callback(cable.stdin.close)
        self._cleanup.callback(cable.stdout.close)
        self._cleanup.callback(cable.wait)
        self._cleanup.callback(cable.kill)
        if cable.stdout.readline() != "ready\n":
            raise OSError("the cable between two TAP devices does not start")
        ip("-n", self.namespace(SWITCH), "link", "set", f"{port}-far", "netns", self.namespace(host), "name", interface)
