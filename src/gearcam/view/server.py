"""The server: one page and its requests, for this computer alone.

Every address begins with a random *token*, which only the page's own address tells. What names
another host (a foreign page that has its name lead here) or comes from another page is refused
before anything else is looked at; paths are compared, never walked.
"""

from __future__ import annotations

import json
import os
import secrets
import socket
import sys
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from string import Template
from typing import Any, Final

from gearcam.console import complain, fault_text
from gearcam.errors import DesignError, Problem
from gearcam.report.page import page
from gearcam.view.session import RequestError, Session

HOME: Final = "127.0.0.1"
"""The only address that is served: this computer's own."""

LARGEST: Final = 64 * 1024
"""Bytes of a request: a thousand numbers with their keys."""

_PATIENCE: Final = 30.0
"""Seconds after which a connection that sends nothing is closed."""

_PULSE: Final = 5.0
"""Seconds after which a page is told that nothing has changed: who has gone is found so."""

_LAST_PORT: Final = 65535

_JSON: Final = "application/json"
_HTML: Final = "text/html; charset=utf-8"

_SAFE: Final = {
    # the page and the view of solids in it are of inline scripts; data: and blob: are the latter's
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
"""What every answer says to the browser."""

_FIRST: Final = Path(__file__).parent / "first.html"


class Server(ThreadingHTTPServer):
    """Serves a session.

    Parameters
    ----------
    session : Session
        What it shows.
    port : int
        Where; 0 takes one that is free.

    Raises
    ------
    DesignError
        If the port is taken or none, with the nearest free one.
    """

    daemon_threads = True
    allow_reuse_address = os.name == "posix"  # elsewhere it would take a port from its owner

    def __init__(self, session: Session, port: int = 0) -> None:
        if not 0 <= port <= _LAST_PORT:
            rule = f"1 to {_LAST_PORT}"
            raise DesignError([Problem(f"{port} is not a port number", key="--port", allowed=rule)])
        self.session = session
        self.token = secrets.token_urlsafe(16)
        try:
            super().__init__((HOME, port), Handler)
        except OSError as error:
            raise DesignError([_taken(port, error)]) from error
        self.hosts = tuple(f"{name}:{self.server_port}" for name in (HOME, "localhost"))

    @property
    def address(self) -> str:
        """Address of the page."""
        return f"http://{self.hosts[0]}/{self.token}/"

    def handle_error(self, request: Any, client_address: Any) -> None:  # noqa: ARG002
        """Say what went wrong, but for a page that has gone meanwhile (see `Server`)."""
        error = sys.exception()
        if isinstance(error, Exception) and not isinstance(error, ConnectionError | TimeoutError):
            complain(fault_text(error, self.session.file))


def _taken(port: int, error: OSError) -> Problem:
    ways = sorted(range(1024, _LAST_PORT + 1), key=lambda other: abs(other - port))
    free = next((other for other in ways[:100] if _is_free(other)), None)
    hint = f"the nearest free port is {free}" if free else ""
    return Problem(f"port {port} cannot be used: {error.strerror}", key="--port", hint=hint)


def _is_free(port: int) -> bool:
    with socket.socket() as probe:
        try:
            probe.bind((HOME, port))
        except OSError:
            return False
    return True


class Handler(BaseHTTPRequestHandler):
    """Answers one connection."""

    protocol_version = "HTTP/1.1"
    timeout = _PATIENCE

    def do_GET(self) -> None:
        """Answer a question."""
        self._answer({"": self._page, "document": self._document, "events": self._events})

    def do_POST(self) -> None:
        """Answer a wish."""
        self._answer({"follow": self._follow, "remedies": self._remedies, "save": self._save})

    def end_headers(self) -> None:
        """Add what every answer says."""
        for name, value in _SAFE.items():
            self.send_header(name, value)
        super().end_headers()

    def version_string(self) -> str:
        """Return the name of the server."""
        return "gearcam"

    def log_message(self, *_: Any) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Keep requests to oneself: the address holds the token."""

    @property
    def _home(self) -> Server:
        return self.server  # pyright: ignore[reportReturnType]

    def _answer(self, routes: dict[str, Callable[[], None]]) -> None:
        """Answer what is asked at a route, if this computer's own page may have asked it."""
        origin = self.headers.get("Origin")
        hosts = self.headers.get_all("Host") or []
        own = {f"http://{host}" for host in self._home.hosts}
        before = f"/{self._home.token}/"
        path = self.requestline.split()[1]  # as it was sent: `path` has slashes taken out
        start, name = path[: len(before)], path[len(before) :]
        alike = secrets.compare_digest(start.encode("utf-8", "replace"), before.encode())
        if len(hosts) != 1 or hosts[0] not in self._home.hosts:
            self._refuse(HTTPStatus.FORBIDDEN, "requests to this host are not answered")
        elif origin is not None and origin not in own:
            self._refuse(HTTPStatus.FORBIDDEN, "requests from other pages are not answered")
        elif not alike or name not in routes:
            self._refuse(HTTPStatus.NOT_FOUND, "there is no such page")
        else:
            routes[name]()

    def _page(self) -> None:
        session, state = self._home.session, self._home.session.state
        if state.document is None:
            # text within it is put in by its script
            live = json.dumps({"file": session.file, **state.told}).replace("<", "\\u003c")
            made = Template(_FIRST.read_text(encoding="utf-8")).substitute(live=live).encode()
        else:
            told = {name: value for name, value in state.told.items() if name != "document"}
            made = page(
                state.document, live={"token": self._home.token, "file": session.file, **told}
            )
        self._send(made, _HTML)

    def _document(self) -> None:
        self._send(_as_json(self._home.session.state.told))

    def _events(self) -> None:
        """Tell the number of each new state, until the page has gone."""
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Connection", "close")
        self.end_headers()
        self.close_connection = True
        session, number = self._home.session, -1
        while not session.ended:
            state = session.wait(number, _PULSE)
            told = f"data: {state.number}\n\n" if state.number != number else ": nothing new\n\n"
            number = state.number
            try:
                self.wfile.write(told.encode())
                self.wfile.flush()
            except OSError:
                return

    def _follow(self) -> None:
        self._reply(self._home.session.follow)

    def _remedies(self) -> None:
        self._reply(self._home.session.remedies)

    def _reply(self, answer: Callable[[dict[str, Any]], bytes | dict[str, Any] | None]) -> None:
        """Send the answer to a request; where a newer one came before it, that it is stale."""
        asked = self._asked()
        if asked is not None:
            try:
                reply = answer(asked)
            except RequestError as error:
                self._refuse(HTTPStatus.BAD_REQUEST, str(error))
            else:
                reply = {"stale": True} if reply is None else reply
                self._send(reply if isinstance(reply, bytes) else _as_json(reply))

    def _save(self) -> None:
        asked = self._asked()
        if asked is not None:
            try:
                self._home.session.save(asked)
            except RequestError as error:
                self._refuse(HTTPStatus.CONFLICT, str(error))
            else:
                self._send(_as_json({"error": ""}))

    def _asked(self) -> dict[str, Any] | None:
        """Return the object that a request holds; None where it has been refused."""
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
        self.close_connection = True  # what it still sends is not read
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
