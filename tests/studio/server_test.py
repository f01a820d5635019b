#!/usr/bin/env python3
"""server_test.py PROGRAM: `graftal studio` as pages, strangers and broken clients meet it."""

import math
import os
import pathlib
import random
import shlex
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from page_client import Closed, File, Page, Refused, Studio, has_type, is_done, is_tile  # noqa: E402

PROGRAM = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "build/release/graftal"

CRYSTAL = """let spread = 0.5
rifs crystal {
  map n { scale 1/2  translate <0, 1/2, 0> }
  map s { scale 1/2  translate <0, -1/2, 0> }
  map e { scale 1/2  translate <spread, 0, 0> }
  terminal sphere
}
"""
# Rays meet hundreds of parts each: its picture of the best quality takes minutes.
HEAVY = "rifs heavy {\n" + "".join(
    f"  map {name} {{ scale 0.7  translate <{x}, {y}, {z}> }}\n"
    for name, x, y, z in [("a", .3, .3, .3), ("b", -.3, .3, -.3), ("c", .3, -.3, -.3), ("d", -.3, -.3, .3),
                          ("e", 0, 0, 0)]) + "  terminal sphere\n}\n"
SMALL = {"name": "crystal.rifs", "text": CRYSTAL, "width": 64, "height": 36, "quality": "draft"}
LONG = {"name": "heavy.rifs", "text": HEAVY, "width": 1280, "height": 720, "quality": "best"}


class Served(unittest.TestCase):
    """A studio in an empty folder, for each test."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.studio = Studio(PROGRAM, folder=self.folder.name)
        self.addCleanup(self.end)

    def end(self):
        self.studio.__exit__()
        self.assertEqual(self.studio.process.returncode, 0, "Ctrl-C ends it cleanly")

    def files(self):
        return sorted(os.listdir(self.folder.name))

    def works(self):
        """A page gets a picture."""
        with self.studio.page() as page:
            page.show(**SMALL)
            page.until(is_done)

    def cpu_seconds(self):
        fields = pathlib.Path(f"/proc/{self.studio.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def idles(self):
        """Waits until the program does nothing for half a second."""
        for _ in range(60):
            before = self.cpu_seconds()
            time.sleep(0.5)
            if self.cpu_seconds() - before < 0.05:
                return True
        return False


class Strangers(Served):
    def test_only_the_token_opens_the_page(self):
        status, headers, page = self.studio.get()
        self.assertEqual(status, 200)
        self.assertIn("<title>", page.decode())
        self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
        self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
        token = self.studio.path.strip("/")
        self.assertRegex(token, "^[0-9a-f]{32}$")
        wrong = token[:-1] + ("0" if token[-1] != "0" else "1")
        for path in ["/", "/index.html", "/socket", f"/{wrong}/", f"/{wrong}/socket", f"/{token[:-1]}/", "//",
                     f"/{token}", f"/x/{token}/", f"/{token}0/"]:
            status, _, body = self.studio.get(path)
            self.assertEqual(status, 404, path)
            self.assertNotIn(token.encode(), body)
        for path in ["../../etc/passwd", "%2e%2e/passwd", "nothing", "index.html/x"]:
            self.assertEqual(self.studio.get(self.studio.path + path)[0], 404, path)

    def test_names_of_strangers_do_not_lead_here(self):
        for host in ["evil.example", "evil.example:80", f"evil.example:{self.studio.port}", "127.0.0.1.evil.example",
                     "localhost.evil.example", "", "[::1", "127.0.0.1:x", "127.0.0.1:"]:
            self.assertEqual(self.studio.get(Host=host)[0], 421, host)
        for host in ["localhost", f"localhost:{self.studio.port}", "127.0.0.1", "[::1]:80"]:
            self.assertEqual(self.studio.get(Host=host)[0], 200, host)

    def test_pages_of_other_sites_get_no_socket(self):
        host = f"127.0.0.1:{self.studio.port}"
        for origin in ["", "null", "http://evil.example", f"https://{host}", f"http://{host}.evil.example",
                       f"http://localhost:{self.studio.port}", f"http://127.0.0.1:{self.studio.port + 1}"]:
            with self.assertRaises(Refused, msg=origin) as refused:
                self.studio.page(origin=origin)
            self.assertEqual(refused.exception.args[0], 403)
        with self.assertRaises(Refused) as refused:
            self.studio.page(host_header="evil.example")
        self.assertEqual(refused.exception.args[0], 421)
        with self.assertRaises(Refused):
            Page(self.studio.host, self.studio.port, "/0123456789abcdef0123456789abcdef/socket")
        self.works()

    def test_only_this_machine_reaches_it(self):
        listening = pathlib.Path(f"/proc/{self.studio.process.pid}/net/tcp").read_text()
        self.assertIn(f"0100007F:{self.studio.port:04X}", listening)
        self.assertNotIn(f"00000000:{self.studio.port:04X}", listening)


class BrokenClients(Served):
    def raw(self):
        return socket.create_connection((self.studio.host, self.studio.port), timeout=20)

    def test_bytes_that_are_no_requests(self):
        chance = random.Random(1)
        for _ in range(100):
            with self.raw() as client:
                client.sendall(bytes(chance.randrange(256) for _ in range(chance.randrange(1, 400))))
        with self.raw() as client:
            client.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + 100_000 * b"x")
            try:
                client.recv(100)
            except ConnectionError:
                pass
        with self.raw() as client:
            client.sendall(f"POST {self.studio.path} HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000000\r\n\r\n"
                           .encode())
            client.recv(1000)
        self.works()

    def test_truncated_and_broken_frames(self):
        whole = Page.frame(b'{"type": "state", "number": 1}')
        broken = [whole[:cut] for cut in range(0, len(whole), 3)]
        broken += [b"\xf1\x80\0\0\0\0", b"\x83\x80\0\0\0\0", Page.frame(b"{}", masked=False),
                   b"\x81\xff" + struct.pack(">Q", 1 << 63) + b"\0\0\0\0", Page.frame(b"\xff\xfe\xfd")]
        for frame in broken:
            with self.studio.page() as page:
                page.socket.sendall(frame)
        self.works()

    def test_a_message_of_100_mb(self):
        before = self.studio.resident_mib()
        with self.studio.page() as page:
            page.receive()
            with self.assertRaises((Closed, ConnectionError)):
                page.send(b"x" * 100_000_000)
                page.until(lambda _: False, 20)
        with self.studio.page() as page:
            page.receive()
            page.send(b"[" * 15_000_000)  # within the limit of a frame, and as deep as it is long
            self.assertEqual(page.receive()["type"], "fault")
        self.assertLess(self.studio.resident_mib(), before + 150)
        self.works()

    def test_random_messages(self):
        """As many as STUDIO_MESSAGES says; 10,000 take about 45 seconds of a processor."""
        chance = random.Random(2)
        values = [None, True, -1, 0, 1, 2, 7.5, 1e300, "", "x", "crystal.rifs", "native", "1e30", "2^99", "draft", [],
                  [0, 0, 1], [1e300, 0, 0], {}, {"spread": 0.3}, {"location": [0, 0, 5]}, CRYSTAL, CRYSTAL[:60],
                  "n.n.(e)*", "../../etc/passwd", ".png", ".usda"]
        fields = ["type", "number", "name", "text", "set", "steps", "time", "seed", "width", "height", "camera", "at",
                  "zoom", "engine", "quality", "threads", "id", "what", "offset", "x", "y", "dx", "dy", "factor",
                  "path", "suffix", "options", "matrix", "from", "to", "value"]
        asks = ["complete", "hover", "definition", "rename", "format", "pick", "zoom", "map", "pull", "digraph", "vary",
                "setting", "thumbnail", "command", "nonsense"]
        with self.studio.page() as page:
            page.receive()
            page.show(**SMALL)
            for i in range(int(os.environ.get("STUDIO_MESSAGES", "1500"))):
                kind = chance.randrange(4)
                message = {chance.choice(fields): chance.choice(values) for _ in range(chance.randrange(6))}
                if kind == 0:
                    page.number += 1
                    message = {**SMALL, **message, "type": "state", "number": page.number}
                elif kind == 1:
                    page.id += 1
                    message = {**message, "type": "ask", "id": page.id, "what": chance.choice(asks)}
                elif kind == 2:
                    text = bytearray(str(message).replace("'", '"').encode())
                    message = bytes(byte for byte in text if chance.randrange(20))
                page.send(message)
                if i % 50 == 0:
                    while page.has_message():
                        page.receive()
            page.number += 1
            last = page.show(**SMALL)
            page.until(lambda message: is_done(message) and message["number"] == last, 300)
        self.assertEqual(self.files(), [])
        self.works()


class ManyPages(Served):
    def test_ten_pages_at_once(self):
        pages = [self.studio.page() for _ in range(10)]
        for i, page in enumerate(pages):
            page.show(**{**SMALL, "set": {"spread": 0.4 + 0.01 * i}})
        pictures = []
        for page in pages:
            picture = bytearray(3 * 64 * 36)
            for message in page.until(is_done):
                if is_tile(message):
                    message.paint(picture, 64)
            pictures.append(bytes(picture))
        self.assertEqual(len(set(pictures)), 10, "each page has its own model")
        for page in pages:
            page.__exit__()
        self.works()

    def test_no_more_pages_than_there_is_room_for(self):
        pages = []
        with self.assertRaises(Refused):
            for _ in range(40):
                pages.append(self.studio.page())
        self.assertGreaterEqual(len(pages), 10)
        for page in pages:
            page.__exit__()
        for _ in range(100):
            try:
                return self.works()
            except Refused:
                time.sleep(0.1)
        self.fail("pages that are gone hold their places")

    def test_a_page_that_vanishes_ends_its_work(self):
        for vanish in ["closes", "resets"]:
            page = self.studio.page()
            page.show(**LONG)
            page.until(is_tile)
            if vanish == "resets":
                page.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            page.socket.close()
            self.assertTrue(self.idles(), vanish)
        self.works()

    def test_ctrl_c_ends_work(self):
        with self.studio.page() as page:
            page.show(**LONG)
            page.until(is_tile)
            begin = time.monotonic()
            self.end()
            self.assertLess(time.monotonic() - begin, 5)


class Sessions(Served):
    def test_a_new_state_ends_the_work_on_the_one_before(self):
        with self.studio.page() as page:
            page.receive()
            page.show(**SMALL)
            page.until(is_done)
            waits = []
            for _ in range(5):
                page.show(**LONG)
                page.until(is_tile)
                begin = time.monotonic()
                last = page.show(**SMALL)
                page.until(lambda message: has_type("findings")(message) and message["number"] == last)
                waits.append(time.monotonic() - begin)
            self.assertLess(sorted(waits)[2], 0.5, waits)  # 0.05 where nothing else runs

    def test_memory_is_flat_over_many_edits(self):
        with self.studio.page() as page:
            page.receive()

            def edit(count):
                for i in range(count):
                    text = CRYSTAL.replace("0.5", f"0.{40 + i % 20}") if i % 3 else CRYSTAL[:40 + i % 60]
                    last = page.show(**{**SMALL, "text": text})
                    page.until(lambda message: has_type("findings")(message) and message["number"] == last)

            edit(300)
            before = self.studio.resident_mib()
            edit(1500)
            self.assertLess(self.studio.resident_mib(), before + 24)

    def test_no_message_waits_for_the_word_of_the_one_before(self):
        """Else a picture's first tile comes 40 ms after the findings, or later: TCP delays small messages."""
        waits = []
        with self.studio.page() as page:
            page.receive()
            for step in range(20):
                number = page.show(**{**SMALL, "set": {"spread": 0.4 + 0.001 * step}})
                page.until(lambda message: has_type("findings")(message) and message["number"] == number)
                begin = time.perf_counter()
                page.until(lambda message: is_tile(message) and message.number == number)
                waits.append(time.perf_counter() - begin)
        self.assertLess(min(waits), 0.03)

    def test_a_picture_is_that_of_the_command_line(self):
        pathlib.Path(self.folder.name, "crystal.rifs").write_text(CRYSTAL)
        with self.studio.page() as page:
            page.receive()
            page.show(**SMALL, set={"spread": 0.45}, seed=3)
            page.until(is_done)
            command = page.answer(page.ask("command"))["command"]
            answer = page.answer(page.ask("write", path="page.png"))
            self.assertEqual(answer.get("path"), "page.png", answer)
            asked = page.ask("write", suffix=".png")
            messages = page.until(lambda message: has_type("answer")(message) and message["id"] == asked)
            download = [message for message in messages if isinstance(message, File)]
            self.assertEqual([file.name for file in download], ["crystal.png"])
        subprocess.run([PROGRAM, *shlex.split(command)[1:], "-o", "line.png", "-q"],
                       cwd=self.folder.name, check=True)
        line = pathlib.Path(self.folder.name, "line.png").read_bytes()
        self.assertEqual(pathlib.Path(self.folder.name, "page.png").read_bytes(), line)
        self.assertEqual(download[0].contents, line)

    def test_two_fingers_take_along_what_is_under_them(self):
        corners = "".join(f"  map m{i} {{ scale 1/2  translate <{x}/2, {y}/2, 0> }}\n"
                          for i, (x, y) in enumerate([(-1, -1), (1, -1), (-1, 1), (1, 1)]))
        board = f"rifs board {{\n{corners}}}\ncamera {{ location <0, 0, 5>  look_at <0, 0, 0>  angle 40 }}\n"
        state = {**SMALL, "name": "board.rifs", "text": board}
        with self.studio.page() as page:
            page.show(**state)
            page.until(is_done)
            x, y = 20.5, 17.5
            held = page.answer(page.ask("pick", x=x, y=y))["point"]
            for dx, dy, factor in [(6, -4, 1), (-3, 5, 2), (9, 2, 0.8)]:
                view = page.answer(page.ask("zoom", x=x, y=y, dx=dx, dy=dy, factor=factor))
                back = page.answer(page.ask("zoom", x=x, y=y, dx=dx, dy=dy, factor=factor))
                self.assertEqual(view, {**back, "id": view["id"]})
                before, state = state, {**state, **{field: view[field] for field in ("at", "zoom", "camera")}}
                page.show(**state)
                x, y = x + dx, y + dy
                # The camera looks along -z, with the y axis up.
                camera = view["camera"]
                right, up, near = (held[i] - camera["location"][i] for i in range(3))
                unit_of_px = 2 * -near * math.tan(math.radians(20)) / SMALL["width"]
                self.assertAlmostEqual(32 + right / unit_of_px, x, 6)
                self.assertAlmostEqual(18 - up / unit_of_px, y, 6)
                back = page.answer(page.ask("zoom", x=x, y=y, dx=-dx, dy=-dy, factor=1 / factor))
                self.assertEqual(back["camera"], before.get("camera"), "the way back leads to the very view")

    def test_a_film_is_that_of_the_command_line(self):
        pathlib.Path(self.folder.name, "crystal.rifs").write_text(CRYSTAL)
        film = {"frames": 5, "fps": 10, "steps": [1, 3], "set": {"spread": [[0, 0.5], [0.25, 0.3], [1, 0.4]]}}
        with self.studio.page() as page:
            page.receive()
            page.show(**SMALL)
            page.until(is_done)
            command = page.answer(page.ask("command", film=film))["command"]
            self.assertIn("--set spread=0.5..0.3@0.25..0.4 --steps 1..3", command)
            asked = page.ask("write", path="film.png", film=film)
            messages = page.until(lambda message: has_type("answer")(message) and message["id"] == asked)
            self.assertEqual(messages[-1].get("path"), "film.png", messages[-1])
            told = [(message["stage"], message["share"]) for message in messages if has_type("progress")(message)]
            order = ["measure", "draw", "assemble"]
            self.assertEqual(told, sorted(told, key=lambda one: (order.index(one[0]), one[1])))
            self.assertLessEqual(max(share for _, share in told), 1)
            self.assertEqual(page.answer(page.ask("write", path="frames/", film=film)).get("path"), "frames/")
            self.assertEqual(page.answer(page.ask("write", path="film.usda", film=film)).get("path"), "film.usda")
            for bad in [{}, {"frames": 2, "set": {"spread": [[0, 1]]}}, {"frames": 2, "steps": 3},
                        {"frames": 2, "set": {"spread": [[0.1, 1], [1, 2]]}}, {"frames": 2, "fps": 0}]:
                self.assertIn("error", page.answer(page.ask("write", suffix=".gif", film=bad)), bad)
        line = [PROGRAM, *shlex.split(command)[1:], "-q"]
        subprocess.run([*line, "-o", "line.png"], cwd=self.folder.name, check=True)
        subprocess.run([*line, "-o", "line/"], cwd=self.folder.name, check=True)
        here = pathlib.Path(self.folder.name)
        self.assertEqual((here / "film.png").read_bytes(), (here / "line.png").read_bytes())
        self.assertIn("#usda 1.0", (here / "film.usda").read_text())
        frames = sorted(path.name for path in (here / "line").glob("*.png"))
        self.assertEqual(len(frames), 5)
        for name in frames:
            self.assertEqual((here / "frames" / name).read_bytes(), (here / "line" / name).read_bytes(), name)

    def test_a_film_is_stopped(self):
        with self.studio.page() as page:
            page.receive()
            page.show(**SMALL)
            page.until(is_done)
            asked = page.ask("write", path="film.gif", film={"frames": 2000, "fps": 25})
            page.until(has_type("progress"))
            page.ask("stop")
            self.assertEqual(page.answer(asked).get("error"), "interrupted")
            self.assertEqual(page.answer(page.ask("write", path="x.png")).get("path"), "x.png")
        self.assertNotIn("film.gif", self.files())

    def test_files_go_below_the_folder_only(self):
        os.symlink("/tmp", pathlib.Path(self.folder.name, "out"))
        with self.studio.page() as page:
            page.receive()
            page.show(**SMALL)
            page.until(is_done)
            for path in ["/tmp/x.png", "../x.png", "a/../../x.png", "out/x.png", "x.sh", "x", ".png/", "nofolder/x.png"]:
                self.assertIn("error", page.answer(page.ask("write", path=path)), path)
            self.assertEqual(page.answer(page.ask("write", path="x.ply", options={"error": 4})).get("path"), "x.ply")
            self.assertIn("error", page.answer(page.ask("write", path="x.ply", options={"keep": "/tmp"})))
        self.assertEqual(self.files(), ["out", "x.ply"])

    def test_a_file_that_comes_is_read(self):
        with self.studio.page() as page:
            page.receive()
            page.show(**{**SMALL, "name": "row.inst", "text": 'use leaf = "leaf.inst"\nobject row { leaf }\n'})
            self.assertIn("cannot open 'leaf.inst'", page.until(has_type("findings"))[-1]["findings"][0]["text"])
            pathlib.Path(self.folder.name, "leaf.inst").write_text("object leaf { sphere }\n")
            self.assertEqual(page.until(has_type("findings"))[-1]["findings"], [])
            page.until(is_done)

    def test_models_name_no_files_elsewhere(self):
        with self.studio.page() as page:
            page.receive()
            page.show(**{**SMALL, "name": "m.inst", "text": 'use x = "/etc/passwd"\nobject m { x }\n'})
            findings = page.until(has_type("findings"))[-1]["findings"]
            self.assertIn("leads out of", findings[0]["text"])


if __name__ == "__main__":
    unittest.main()
