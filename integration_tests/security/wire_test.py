"""No attitude travels in plain text under `encrypt`, and nothing captured is accepted twice; the twin without security shows both."""
import socket
import unittest

from integration_tests.security.run_wire import look


def may_capture():
    try:
        socket.socket(socket.AF_PACKET, socket.SOCK_RAW).close()
        return True
    except PermissionError:
        return False


@unittest.skipUnless(may_capture(), "no permission to capture packets")
class Wire(unittest.TestCase):
    def test_shows_nothing_under_encrypt_and_accepts_nothing_twice(self):
        self.assertEqual(list(look("encrypt").broken()), [])

    def test_shows_everything_without_security(self):
        self.assertEqual(list(look("none").broken()), [])


if __name__ == "__main__":
    unittest.main()
