#!/usr/bin/python3
"""Serve a folder to browsers of this computer. usage: serve-page FOLDER [PORT]"""
import functools
import http.server
import sys

FIRST, LAST = 8080, 8180


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".js": "text/javascript", ".wasm": "application/wasm"}

    def log_message(self, *_):
        pass

    def end_headers(self):
        self.send_header("Cache-Control", "no-store")  # what is built anew is seen at once
        super().end_headers()


def server(folder, ports):
    """On the first port that is free."""
    handler = functools.partial(Handler, directory=folder)
    for port in ports:
        try:
            return http.server.ThreadingHTTPServer(("127.0.0.1", port), handler)
        except OSError as wrong:
            reason = wrong
    sys.exit(f"web: port {ports[0]}: {reason.strerror}")


def main():
    folder, *given = sys.argv[1:]
    ports = [int(given[0])] if given else range(FIRST, LAST)
    with server(folder, ports) as serving:
        print(f"Open http://localhost:{serving.server_port}/ in a browser. Ctrl-C ends.", flush=True)
        try:
            serving.serve_forever()
        except KeyboardInterrupt:
            print()


if __name__ == "__main__":
    main()
