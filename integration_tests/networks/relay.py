#!/usr/bin/env python3
"""A bad cable: carries Ethernet frames between two TAP devices, late and with flipped bits.

The kernel's own network emulation (tc netem) is a module that many kernels do not have; TAP devices are everywhere. A frame written to a
TAP device has its checksums verified like one from a wire, so a flipped bit ends as a lost packet, unless it hits what no checksum covers.

Begins as a good cable; a line `bad` on its input makes it bad, `good` good again, the end of the input ends it."""
import argparse
import collections
import fcntl
import os
import random
import select
import struct
import sys
import time

TUNSETIFF = 0x400454CA  # linux/if_tun.h
IFF_TAP, IFF_NO_PI = 0x0002, 0x1000
LONGEST_FRAME = 65550
BEHIND_ADDRESSES = 14  # of an Ethernet header


def open_tap(name):
    device = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(device, TUNSETIFF, struct.pack("16sH22x", name.encode(), IFF_TAP | IFF_NO_PI))
    return device


def with_flipped_bit(frame, chance):
    damaged = bytearray(frame)
    damaged[chance.randrange(BEHIND_ADDRESSES, len(frame))] ^= 1 << chance.randrange(8)
    return bytes(damaged)


def forward(frame, device):
    try:
        os.write(device, frame)
    except OSError:
        pass  # the device is down, or its queue is full: a cable loses the frame


class Cable:
    def __init__(self, one, other, delay_s, corruption, chance):
        self._opposite = {one: other, other: one}
        self._delay_s, self._corruption, self._chance = delay_s, corruption, chance
        self._bad = False
        self._on_the_way = collections.deque()  # (due, frame, device); order is kept

    def carry(self):
        while True:
            timeout_s = max(0.0, self._on_the_way[0][0] - time.monotonic()) if self._on_the_way else None
            for source in select.select([*self._opposite, sys.stdin], [], [], timeout_s)[0]:
                if source is not sys.stdin:
                    self._take(source)
                elif not self._obey(sys.stdin.readline()):
                    return
            while self._on_the_way and self._on_the_way[0][0] <= time.monotonic():
                _, frame, device = self._on_the_way.popleft()
                forward(frame, device)

    def _obey(self, word):
        self._bad = word == "bad\n"
        return bool(word)

    def _take(self, source):
        try:
            frame = os.read(source, LONGEST_FRAME)
        except OSError:
            return  # the device is down
        if self._bad and self._chance.random() < self._corruption:
            frame = with_flipped_bit(frame, self._chance)
        self._on_the_way.append((time.monotonic() + (self._delay_s if self._bad else 0), frame, self._opposite[source]))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("devices", nargs=2, help="TAP devices to make")
    parser.add_argument("--delay-ms", type=float, default=0, help="each way")
    parser.add_argument("--corruption", type=float, default=0, help="probability that a frame has one bit flipped")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    one, other = map(open_tap, options.devices)
    print("ready", flush=True)
    Cable(one, other, options.delay_ms * 1e-3, options.corruption, random.Random(options.seed)).carry()


if __name__ == "__main__":
    main()
