"""The server: one page and its requests, for this computer only.

Every path begins with a *token*, known only from the address of the page. Requests that name
another host (DNS rebinding) or come from another page are refused first; paths are only compared
with known ones, never opened as files. Each start is a *run* with a name of its own: a page that
was left open learns from it that the server was started again.
"""

from __future__ import annotations

import json
import os
import secrets
import sys
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from string import Template
from typing import Any, Final

from gearcam.base.errors import DesignError, Problem
from gearcam.console import complain, fault_text
from gearcam.report.page import page
from gearcam.view.session import RequestError, Session
from gearcam.view.token import token_of

HOME: Final = "127.0.0.1"
"""The only address that is served: the loopback address of this computer."""

LARGEST: Final = 64 * 1024
"""Largest size of a request, bytes: a thousand numbers with their keys."""

_PATIENCE: Final = 30.0
"""Time after which an unused connection is closed, s."""

_PULSE: Final = 5.0
"""Interval of events without news, s: they reveal closed pages."""

_LAST_PORT: Final = 65535

_JSON: Final = "application/json"
_HTML: Final = "text/html; charset=utf-8"

_SAFE: Final = {
    # page and view of solids have inline scripts; the latter uses data: and blob:
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
        "img-src data: blob:; font-src data:; connect-src 'self' data: blob:; "
        "frame-src 'self' data: blob:; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    ),
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
"""Headers of every response."""

_FIRST: Final = Path(__file__).parent / "first.html"


class Server(ThreadingHTTPServer):
    """Server of a session.

    Parameters
    ----------
    session : Session
        The session that is shown.
    port : int
        Port; 0 takes a free one.

    Raises
    ------
    DesignError
        If the port is invalid or in use.
    """

    daemon_threads = True
    allow_reuse_address = os.name == "posix"  # elsewhere it would take a port from its owner

    def __init__(self, session: Session, port: int = 0) -> None:
        if not 0 <= port <= _LAST_PORT:
            rule = f"1 to {_LAST_PORT}"
            raise DesignError.of(f"{port} is not a port number", key="--port", allowed=rule)
        self.session = session
        self.token, self.run = token_of(session.file, port), secrets.token_hex(8)
        try:
            super().__init__((HOME, port), Handler)
        except OSError as error:
            message = f"port {port} cannot be used: {error.strerror}"
            hint = "without --port a free one is taken"
            raise DesignError([Problem(message, key="--port", hint=hint)]) from error
        self.hosts = tuple(f"{name}:{self.server_port}" for name in (HOME, "localhost"))

    @property
    def address(self) -> str:
        """Address of the page."""
        return f"http://{self.hosts[0]}/{self.token}/"

    def handle_error(self, request: Any, client_address: Any) -> None:  # noqa: ARG002
        """Print an error of a `request` from a `client_address`, unless the page was closed."""
        error = sys.exception()
        if isinstance(error, Exception) and not isinstance(error, ConnectionError | TimeoutError):
            complain(fault_text(error, self.session.file))


class Handler(BaseHTTPRequestHandler):
    """Handler of one connection."""

    protocol_version = "HTTP/1.1"
    timeout = _PATIENCE

    def do_GET(self) -> None:
        """Answer a GET request."""
        self._answer({"": self._page, "document": self._document, "events": self._events})

    def do_POST(self) -> None:
        """Answer a POST request."""
        session = self._home.session
        self._answer(
            {
                "follow": lambda: self._reply(session.follow),
                "remedies": lambda: self._reply(session.remedies),
                "handles": lambda: self._reply(session.handles),
                "solids": lambda: self._reply(session.solids),
                "save": lambda: self._reply(session.save, HTTPStatus.CONFLICT),
            }
        )

    def end_headers(self) -> None:
        """Add the headers of every response."""
        for name, value in _SAFE.items():
            self.send_header(name, value)
        super().end_headers()

    def version_string(self) -> str:
        """Return the name of the server."""
        return "gearcam"

    def log_message(self, *_: Any) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Log nothing: addresses contain the token."""

    @property
    def _home(self) -> Server:
        return self.server  # pyright: ignore[reportReturnType]

    def _answer(self, routes: dict[str, Callable[[], None]]) -> None:
        """Answer a request by its route if it can come from the page itself."""
        origin = self.headers.get("Origin")
        hosts = self.headers.get_all("Host") or []
        origins = {f"http://{host}" for host in self._home.hosts}
        before = f"/{self._home.token}/"
        path = self.requestline.split()[1]  # as sent: `path` is without double slashes
        start, name = path[: len(before)], path[len(before) :]
        alike = secrets.compare_digest(start.encode("utf-8", "replace"), before.encode())
        if len(hosts) != 1 or hosts[0] not in self._home.hosts:
            self._refuse(HTTPStatus.FORBIDDEN, "requests to this host are not answered")
        elif origin is not None and origin not in origins:
            self._refuse(HTTPStatus.FORBIDDEN, "requests from other pages are not answered")
        elif not alike or name not in routes:
            self._refuse(HTTPStatus.NOT_FOUND, "there is no such page")
        else:
            routes[name]()

    def _page(self) -> None:
        session, state = self._home.session, self._home.session.state
        if state.document is None:
            # texts are inserted by its script
            told = {"file": session.file, "run": self._home.run, **state.message}
            live = json.dumps(told).replace("<", "\\u003c")
            content = Template(_FIRST.read_text(encoding="utf-8")).substitute(live=live).encode()
        else:
            more = {name: value for name, value in state.message.items() if name != "document"}
            live = {"token": self._home.token, "run": self._home.run, "file": session.file}
            live |= {name: state.document[name] for name in ("kind", "solids")}
            content = page(state.document, live=live | more)
        self._send(content, _HTML)

    def _document(self) -> None:
        self._send(_as_json(self._home.session.state.message))

    def _events(self) -> None:
        """Send the run, then the number of each new state until the page is closed."""
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Connection", "close")
        self.end_headers()
        self.close_connection = True
        session, number = self._home.session, -1
        before = f"event: run\ndata: {self._home.run}\n\n"
        while not session.ended:
            state = session.wait(number, _PULSE)
            event = f"data: {state.number}\n\n" if state.number != number else ": nothing new\n\n"
            number = state.number
            try:
                self.wfile.write((before + event).encode())
                self.wfile.flush()
            except OSError:
                return
            before = ""

    def _reply(
        self,
        answer: Callable[[dict[str, Any]], bytes | dict[str, Any] | None],
        refused: HTTPStatus = HTTPStatus.BAD_REQUEST,
    ) -> None:
        """Send the answer to a request, or that it was overtaken by a newer one."""
        asked = self._asked()
        if asked is not None:
            try:
                reply = answer(asked)
            except RequestError as error:
                self._refuse(refused, str(error))
            else:
                reply = {"stale": True} if reply is None else reply
                self._send(reply if isinstance(reply, bytes) else _as_json(reply))

    def _asked(self) -> dict[str, Any] | None:
        """Return the object in a request; None if it was refused."""
        kind, length = self.headers.get("Content-Type", ""), self.headers.get("Content-Length", "")
        if kind.partition(";")[0].strip().lower() != _JSON:
            self._refuse(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, f"the request is not {_JSON}")
        elif "Transfer-Encoding" in self.headers or not (length.isascii() and length.isdigit()):
            self._refuse(HTTPStatus.LENGTH_REQUIRED, "the length of the request is missing")
        elif len(length) > len(str(LARGEST)) or int(length) > LARGEST:
            self._refuse(
                HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"the request has more than {LARGEST} bytes"
            )
        else:
            try:
                asked = json.loads(self.rfile.read(int(length)))
            except (ValueError, RecursionError):
                asked = None
            if isinstance(asked, dict):
                return asked
            self._refuse(HTTPStatus.BAD_REQUEST, "the request is not a JSON object")
        return None

    def _refuse(self, status: HTTPStatus, error: str) -> None:
        self.close_connection = True  # the rest of the request is not read
        self._send(_as_json({"error": error}), status=status)

    def _send(self, content: bytes, kind: str = _JSON, status: HTTPStatus = HTTPStatus.OK) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(content)


def _as_json(data: Any) -> bytes:
    return json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
