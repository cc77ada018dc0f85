"""The page of a stream, served on this machine: states are sent as they come, and buttons are received.

`plantar.viewer.view`'s style and drawings; server-sent events, by the standard library. The page holds a token, without
which neither the stream nor the buttons answer, and a request has to name the address that is served: a page of another
origin can do neither.
"""

import json
import secrets
import socket
import threading
import time
from collections.abc import Callable, Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from queue import Empty, SimpleQueue
from typing import Any
from urllib.parse import parse_qs, urlsplit

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.live.source import Unit
from plantar.viewer.page import asset, framed

ACTIONS = ("zero", "mark", "record")
"""What the page's buttons ask for."""

_MOST_BYTES = 200  # of a button's request
_MOST_VIEWERS = 8
_QUIET = 2.0  # s after which a line without content is sent: it shows whether a viewer is still there
_PATIENCE = 5.0  # s for which a request may take
_PICTURE = 1.0 / 60.0  # s between two states: a screen's
_UNSENT = 1 << 14  # bytes that the system keeps for a viewer: some states, so that a slow one gets no old ones


class LivePage:
    """A page that shows the states that it is sent; a context manager, which serves it.

    Args:
        soles: Layout of each side.
        title: Of the page.
        host: Address that is listened to; 0.0.0.0 for all of the machine.
        port: 0 for a free one.
        unit: Of the forces: "N" or "counts".

    Attributes:
        url: Where the page is.

    Raises:
        InputError: If it cannot be served there.

    Example:
        >>> from plantar import hex_layout
        >>> sole = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]], side="left")
        >>> with LivePage({"left": sole}, "my sole") as page:
        ...     page.url.startswith("http://127.0.0.1:"), page.actions()
        (True, [])
    """

    def __init__(
        self,
        soles: Mapping[Side, SoleLayout],
        title: str,
        host: str = "127.0.0.1",
        port: int = 0,
        unit: Unit = "N",
    ) -> None:
        self._token = secrets.token_urlsafe(16)
        self._news = threading.Condition()
        self._make: Callable[[], Mapping[str, Any]] = dict
        self._number = 0
        self._state = b""
        self._made = 0  # number of what `_state` holds
        self._ended = False
        self._viewers = threading.Semaphore(_MOST_VIEWERS)
        self._actions: SimpleQueue[str] = SimpleQueue()
        self._page = _page(soles, title, self._token, unit)
        try:
            self._server = _Server((host, port), self)
        except (OSError, OverflowError) as error:
            raise InputError(f"no page can be served at {host}:{port}: {error}") from None
        self._hosts = {f"{name}:{self._server.server_port}" for name in ("127.0.0.1", "localhost", host)}
        self._everywhere = host in ("0.0.0.0", "::")
        self.url = f"http://{'127.0.0.1' if self._everywhere else host}:{self._server.server_port}/"
        self._thread = threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.2}, daemon=True)

    def __enter__(self) -> "LivePage":
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        with self._news:
            self._ended = True
            self._news.notify_all()
        self._server.shutdown()
        self._server.server_close()

    def send(self, state: Mapping[str, Any] | Callable[[], Mapping[str, Any]]) -> None:
        """Send a state to all viewers, each of which gets the latest one when its next picture is due.

        Args:
            state: What `LiveState.as_dict` gives, with status, recording and time of arrival; or what gives it when it
                is called, in another thread.
        """
        with self._news:
            self._make = state if callable(state) else lambda: state
            self._number += 1
            self._news.notify_all()

    def actions(self) -> list[str]:
        """Names of buttons that were pressed since the last call, of `ACTIONS`."""
        found = []
        while True:
            try:
                found.append(self._actions.get_nowait())
            except Empty:
                return found

    def _latest(self, known: int, due: float) -> tuple[int, bytes]:
        """Number and text of the latest state after a known one, when its picture is due by the monotonic clock.

        The known number after a quiet time; -1 at the end.
        """
        with self._news:
            if not self._news.wait_for(lambda: self._ended or self._number != known, _QUIET):
                return known, b""
        time.sleep(max(0.0, due - time.monotonic()))
        with self._news:
            if self._number == known:
                return -1, b""
            if self._made != self._number:
                self._state = json.dumps(self._make(), separators=(",", ":"), allow_nan=False).encode()
                self._made = self._number
            return self._number, self._state


def _page(soles: Mapping[Side, SoleLayout], title: str, token: str, unit: Unit) -> bytes:
    data = {
        "token": token,
        "unit": unit,
        "soles": {
            side: {
                "cells": [layout.vertices[list(corners), :2].round(5).tolist() for corners in layout.corners],
                "outline": layout.outline.round(5).tolist(),
                "ids": layout.ids.tolist(),
            }
            for side, layout in soles.items()
        },
    }
    style = asset("view.css") + asset("live.css")
    script = asset("soles.js") + asset("live.js")
    text = framed(title, style, asset("live.html"), script, json.dumps(data, separators=(",", ":")))
    return text.replace("connect-src 'none'", "connect-src 'self'", 1).encode()


class _Server(ThreadingHTTPServer):
    """The server of one page."""

    daemon_threads = True

    def __init__(self, address: tuple[str, int], page: LivePage) -> None:
        self.page = page
        super().__init__(address, _Handler)


class _Handler(BaseHTTPRequestHandler):
    """One request."""

    server: _Server
    timeout = _PATIENCE
    disable_nagle_algorithm = True  # else a state waits until the one before is acknowledged, 40 ms
    protocol_version = "HTTP/1.1"

    def log_message(self, *_: object) -> None:
        """Requests are not printed."""

    def do_GET(self) -> None:
        place = urlsplit(self.path)
        if not self._addressed():
            self._answer(403)
        elif place.path == "/":
            self._answer(200, self.server.page._page, "text/html; charset=utf-8")
        elif place.path == "/stream" and self._knows(parse_qs(place.query).get("token", [""])[0]):
            self._stream()
        else:
            self._answer(404)

    def do_POST(self) -> None:
        size = self.headers.get("Content-Length", "")
        if not (self._addressed() and self.path == "/do" and self._knows(self.headers.get("X-Plantar", ""))):
            self._answer(403)
            return
        if not (size.isdigit() and int(size) <= _MOST_BYTES):
            self._answer(413)
            return
        try:
            asked = json.loads(self.rfile.read(int(size)))["do"]
        except (ValueError, TypeError, KeyError, RecursionError):
            asked = None
        if asked not in ACTIONS:
            self._answer(400)
            return
        self.server.page._actions.put(asked)
        self._answer(204)

    def _addressed(self) -> bool:
        """Whether the request names the address that is served: a page of another name is kept out."""
        return self.server.page._everywhere or self.headers.get("Host", "") in self.server.page._hosts

    def _knows(self, token: str) -> bool:
        return secrets.compare_digest(token.encode(), self.server.page._token.encode())

    def _answer(self, code: int, body: bytes = b"", kind: str = "text/plain") -> None:
        self.send_response(code)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("X-Frame-Options", "DENY")
        self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(body)
        self.close_connection = True

    def _stream(self) -> None:
        if not self.server.page._viewers.acquire(blocking=False):
            self._answer(503)
            return
        try:
            self.send_response(200)
            self.send_header("Content-Type", "text/event-stream")
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.close_connection = True
            self.connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _UNSENT)
            known = 0
            due = 0.0
            while True:
                number, text = self.server.page._latest(known, due)
                due = time.monotonic() + _PICTURE
                if number < 0:
                    return
                self.wfile.write(b":\n\n" if number == known else b"data: " + text + b"\n\n")
                self.wfile.flush()
                known = number
        except OSError:
            return  # the viewer went away
        finally:
            self.server.page._viewers.release()
