"""A WebSocket client that can behave badly (RFC 6455), for tests."""
import base64
import contextlib
import json
import os
import socket
import struct

TEXT, BINARY, CLOSE, PING = 1, 2, 8, 9


class WebSocket:
    def __init__(self, port, protocol, origin=None, receive_buffer=None, cookie=None):
        self.socket = socket.socket()
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(10)
        self.socket.connect(("127.0.0.1", port))
        lines = ["GET / HTTP/1.1", f"Host: 127.0.0.1:{port}", "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                 f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}", f"Sec-WebSocket-Protocol: {protocol}"]
        lines += [f"Origin: {origin}"] if origin else []
        lines += [f"Cookie: {cookie}"] if cookie else []
        request = ("\r\n".join(lines) + "\r\n\r\n").encode()
        self.file = self.socket.makefile("rb")
        self.status = 0  # closed without an answer: the server has as many viewers as it takes
        self.headers = {}
        with contextlib.suppress(ConnectionError):
            self.socket.sendall(request[:30])  # in two pieces, as a slow network delivers it
            self.socket.sendall(request[30:])
            self.read_answer()

    def read_answer(self):
        if not (line := self.file.readline()):
            return
        self.status = int(line.split()[1])
        while line := self.file.readline().strip().decode():
            name, value = line.split(": ", 1)
            self.headers[name.lower()] = value

    def send(self, payload, kind=TEXT):
        mask = os.urandom(4)
        size = len(payload)
        header = bytes([0x80 | kind]) + (bytes([0x80 | size]) if size < 126 else bytes([0x80 | 126]) + struct.pack(">H", size))
        self.socket.sendall(header + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload)))

    def send_json(self, value):
        self.send(json.dumps(value).encode())

    def receive(self):
        """Kind and payload of the next frame; None where the server has closed."""
        head = self.file.read(2)
        if len(head) < 2:
            return None
        size = head[1] & 0x7F
        if size == 126:
            size = struct.unpack(">H", self.file.read(2))[0]
        elif size == 127:
            size = struct.unpack(">Q", self.file.read(8))[0]
        return head[0] & 0x0F, self.file.read(size)

    def close(self):
        self.file.close()
        self.socket.close()
