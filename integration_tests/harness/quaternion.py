"""Quaternions (w, x, y, z) as the tests need them, independent of the code under test."""
import math


def conjugate(q):
    return [q[0], -q[1], -q[2], -q[3]]


def product(p, q):
    return [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]


def angle(p, q):
    """Between two attitudes [rad]; by the sine, since the cosine is blind below 1e-8."""
    w, x, y, z = product(conjugate(p), q)
    return 2 * math.atan2(math.hypot(x, y, z), abs(w))
