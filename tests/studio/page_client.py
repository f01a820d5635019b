"""A page of the studio as a script: the program, its address, HTTP requests and a WebSocket, by the standard library."""

import base64
import http.client
import json
import os
import pathlib
import select
import signal
import socket
import struct
import subprocess
import time
import urllib.parse
import zlib

FIRST_ID = 1 << 30


class Studio:
    """The program `graftal studio`, until the end of a `with`."""

    def __init__(self, program, *options, folder=None):
        self.process = subprocess.Popen([program, "studio", "--no-browser", "-q", *options], cwd=folder,
                                        stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        address = urllib.parse.urlsplit(self.url)
        self.host, self.port, self.path = address.hostname, address.port, address.path

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        finally:
            self.process.stdout.close()

    def get(self, path=None, method="GET", **headers):
        """The status, headers and bytes of a request."""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=20)
        try:
            connection.request(method, self.path if path is None else path, headers=headers)
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read()
        finally:
            connection.close()

    def page(self, **changes):
        return Page(self.host, self.port, self.path + "socket", **changes)

    def resident_mib(self):
        for line in pathlib.Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
            if line.startswith("VmRSS:"):
                return int(line.split()[1]) / 1024
        return 0


class Refused(Exception):
    """The server answered with another status than 101."""


class Closed(Exception):
    """The server ended the socket."""


class Page:
    """A WebSocket (RFC 6455), and the messages of docs/studio.md."""

    def __init__(self, host, port, path, origin=None, host_header=None):
        self.socket = socket.create_connection((host, port), timeout=60)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.bytes = b""
        self.number = 0
        self.id = FIRST_ID
        name = host_header or f"{host}:{port}"
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET {path} HTTP/1.1", f"Host: {name}", "Upgrade: websocket", "Connection: Upgrade",
                 f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
        if origin != "":
            lines.append(f"Origin: {origin or 'http://' + name}")
        self.socket.sendall("\r\n".join(lines + ["", ""]).encode())
        while b"\r\n\r\n" not in self.bytes:
            piece = self.socket.recv(65536)
            if not piece:
                raise Closed()
            self.bytes += piece
        head, self.bytes = self.bytes.split(b"\r\n\r\n", 1)
        status = int(head.split()[1])
        if status != 101:
            self.socket.close()
            raise Refused(status)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    @staticmethod
    def frame(payload, opcode=1, masked=True):
        length = len(payload)
        head = bytes([0x80 | opcode])
        mask_bit = 0x80 if masked else 0
        if length < 126:
            head += bytes([mask_bit | length])
        elif length < 65536:
            head += bytes([mask_bit | 126]) + struct.pack(">H", length)
        else:
            head += bytes([mask_bit | 127]) + struct.pack(">Q", length)
        if not masked:
            return head + payload
        return head + b"\0\0\0\0" + payload  # a mask of zeros changes nothing

    def send(self, message):
        text = message if isinstance(message, (bytes, str)) else json.dumps(message)
        self.socket.sendall(self.frame(text.encode() if isinstance(text, str) else text))

    def show(self, **state):
        """Sends a state; its number."""
        self.number += 1
        self.send({"type": "state", "number": self.number, "width": 960, "height": 540, **state})
        return self.number

    def ask(self, what, **fields):
        self.id += 1
        self.send({"type": "ask", "id": self.id, "what": what, **fields})
        return self.id

    def _need(self, count, deadline):
        while len(self.bytes) < count:
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([self.socket], [], [], left)[0]:
                raise TimeoutError()
            piece = self.socket.recv(1 << 18)
            if not piece:
                raise Closed()
            self.bytes += piece

    def has_message(self):
        """Whether something waits to be received."""
        return bool(self.bytes) or bool(select.select([self.socket], [], [], 0)[0])

    def receive(self, seconds=60):
        """The next message: an object, or a Tile or File."""
        deadline = time.monotonic() + seconds
        parts = b""  # of a message in several frames
        while True:
            self._need(2, deadline)
            final, opcode, length, begin = self.bytes[0] & 128, self.bytes[0] & 15, self.bytes[1] & 127, 2
            if length >= 126:
                size = 2 if length == 126 else 8
                self._need(2 + size, deadline)
                length, begin = int.from_bytes(self.bytes[2:2 + size], "big"), 2 + size
            self._need(begin + length, deadline)
            payload, self.bytes = self.bytes[begin:begin + length], self.bytes[begin + length:]
            if opcode in (0, 1, 2):
                kind = opcode or kind
                parts += payload
                if not final:
                    continue
                payload, parts, opcode = parts, b"", kind
            if opcode == 1:
                return json.loads(payload)
            if opcode == 2:
                return binary(payload)
            if opcode == 8:
                raise Closed()
            if opcode == 9:
                self.socket.sendall(self.frame(payload, 10))

    def until(self, wanted, seconds=60):
        """All messages up to the first that is wanted."""
        heard = []
        deadline = time.monotonic() + seconds
        while True:
            heard.append(self.receive(max(0.001, deadline - time.monotonic())))
            if wanted(heard[-1]):
                return heard

    def answer(self, id, seconds=60):
        return self.until(lambda m: isinstance(m, dict) and m.get("type") == "answer" and m["id"] == id,
                          seconds)[-1]


class Tile:
    def __init__(self, words, samples):
        self.number, self.pass_, self.x, self.y, self.width, self.height, self.block = words
        self.rgb = samples

    def paint(self, picture, width):
        """Into a bytearray of rows of `width` pixels."""
        across = -(-self.width // self.block)
        for y in range(self.height):
            row = (y // self.block) * across * 3
            if self.block == 1:
                line = self.rgb[row:row + 3 * self.width]
            else:
                line = b"".join(self.rgb[row + 3 * (x // self.block):row + 3 * (x // self.block) + 3]
                                for x in range(self.width))
            begin = 3 * ((self.y + y) * width + self.x)
            picture[begin:begin + 3 * self.width] = line


class File:
    def __init__(self, id, name, contents):
        self.id, self.name, self.contents = id, name, contents


def binary(message):
    words = struct.unpack("<8I", message[:32])
    contents = zlib.decompress(message[32:])
    if words[0] == 0x4c495447:
        return Tile(words[1:], contents)
    assert words[0] == 0x4c494647, hex(words[0])
    return File(words[1], contents[:words[2]].decode(), contents[words[2]:])


def is_tile(message):
    return isinstance(message, Tile)


def has_type(kind):
    return lambda message: isinstance(message, dict) and message.get("type") == kind


def is_done(message):
    return has_type("pass")(message) and message["done"]
