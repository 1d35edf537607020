"""A live view within the test's own process: threads in place of workers."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path
from typing import Any

from gearcam.view.server import Server
from gearcam.view.session import Session, State

DESIGN = """\
# two equal wheels
kind = "gear-pair"
name = "wheels"  # not the file's

[law]
type = "constant"

[pair]
teeth = [ 12 , 12 ]      # driver first
module_mm = 2.0          # or the distance
face_width_mm = 5

[output]
files = ["csv"]
"""
SECONDS = 60.0
"""After which a test gives up: far more than a build takes."""


@dataclass
class Shown:
    """A session with what it has told."""

    session: Session
    states: list[State] = field(default_factory=list)

    def after(self, number: int, *, whole: bool = True) -> State:
        """The first state later than a number, one that tells of the whole design or of a fault."""
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            state = self.session.wait(number, SECONDS)
            if not whole or state.error or state.news is state.document is not None:
                return state
            number = state.number
        raise TimeoutError

    def refresh(self, content: bytes | None = None) -> State:
        before = self.session.state.number
        self.session.refresh(Path(self.session.file).read_bytes() if content is None else content)
        return self.after(before)


@contextmanager
def shown(file: Path) -> Iterator[Shown]:
    with ThreadPoolExecutor(2) as workers:
        states: list[State] = []
        session = Session(str(file), workers, 2, states.append)
        yield Shown(session, states)
        session.end()


def free_port() -> int:
    """A port that nothing uses now."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@contextmanager
def served(file: Path, port: int = 0) -> Iterator[tuple[Server, Shown]]:
    with shown(file) as view, Server(view.session, port) as server:
        threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02}).start()
        view.refresh()
        try:
            yield server, view
        finally:
            view.session.end()
            server.shutdown()


def ask(
    server: Server,
    route: str,
    body: bytes | None = None,
    *,
    method: str = "",
    headers: dict[str, str] | None = None,
    hosts: tuple[str, ...] | None = None,
    path: str | None = None,
) -> tuple[HTTPResponse, bytes]:
    """Send a request as a browser does not: with any path, host and header."""
    connection = HTTPConnection("127.0.0.1", server.server_port, timeout=SECONDS)
    address = f"/{server.token}/{route}" if path is None else path
    connection.putrequest(method or ("GET" if body is None else "POST"), address, skip_host=True)
    for host in (f"127.0.0.1:{server.server_port}",) if hosts is None else hosts:
        connection.putheader("Host", host)
    given: dict[str, Any] = {} if body is None else {"Content-Type": "application/json"}
    given |= {"Content-Length": str(len(body))} if body is not None else {}
    for name, value in (given | (headers or {})).items():
        if value:
            connection.putheader(name, value)
    connection.endheaders(body)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer, content
