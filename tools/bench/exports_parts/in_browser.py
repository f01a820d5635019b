"""Headless Chromium shows in_browser.html, with the files of a folder, and says what it found."""
import http.server
import json
import subprocess
import tempfile
import threading
import urllib.parse
from pathlib import Path

PAGE = Path(__file__).resolve().with_suffix('.html')
# WebGL by the processor: the same pixels on every machine.
FLAGS = ['--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, '.wasm': 'application/wasm'}

    def do_GET(self):
        if self.path.split('?')[0] != '/':
            return super().do_GET()
        page = PAGE.read_bytes()
        self.send_response(200)
        self.send_header('Content-Type', 'text/html')
        self.send_header('Content-Length', str(len(page)))
        self.end_headers()
        self.wfile.write(page)

    def do_POST(self):
        self.server.said = json.loads(self.rfile.read(int(self.headers['Content-Length'])))
        self.send_response(204)
        self.end_headers()
        self.server.done.set()

    def log_message(self, *_):
        pass


def measured(folder, seconds=300, **ask):
    """`folder` also has node_modules with three and tinyusdz. A dictionary; 'fault' in it if something went wrong."""
    server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), lambda *words: Handler(*words, directory=folder))
    server.said, server.done = {'fault': f'no answer within {seconds} s'}, threading.Event()
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:  # it may still write there
        url = f'http://127.0.0.1:{server.server_port}/?{urllib.parse.urlencode(ask)}'
        browser = subprocess.Popen(['chromium', *FLAGS, f'--user-data-dir={profile}', '--remote-debugging-port=0', url],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        server.done.wait(seconds)
        browser.terminate()
        browser.wait()
    server.shutdown()
    return server.said
