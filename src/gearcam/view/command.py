"""The command ``view``: serves the page and watches the file until it is interrupted."""

from __future__ import annotations

import threading
import time
import webbrowser
from argparse import ArgumentParser
from collections.abc import Callable

from gearcam.base.errors import DesignError
from gearcam.base.interrupts import unbroken
from gearcam.commands import GOOD, Options, each
from gearcam.console import complain, say
from gearcam.designs.reader import STDIN, content_of
from gearcam.view.server import Server
from gearcam.view.session import Session, State
from gearcam.view.watch import PAUSE, Watch
from gearcam.view.workers import Workers


def arguments(parser: ArgumentParser) -> None:
    """Add the command's file and options to a `parser`."""
    parser.add_argument("file", metavar="FILE", help="design file (TOML)")
    words = "port of the page (default: any free port)"
    parser.add_argument("--port", type=int, default=0, metavar="N", help=words)
    words = "print the address without opening a browser"
    parser.add_argument("--no-browser", action="store_true", help=words)


def view(options: Options) -> int:
    """Serve the page of a design file and update it until interrupted (Ctrl-C)."""

    def work(file: str) -> int:
        _serve(file, options["port"], browser=not options["no_browser"])
        return GOOD

    return each([options["file"]], "shown", work)


def _serve(file: str, port: int, *, browser: bool) -> None:
    """Serve the page of a design `file`; one with errors is shown once it is corrected."""
    if file == STDIN:
        what = "the live view follows a file and cannot show the standard input"
        raise DesignError.of(what, allowed="the name of a design file")
    content_of(file)
    workers = Workers()
    session = Session(file, workers, workers.count, reporter(file))
    with Server(session, port) as server:
        try:
            with unbroken():
                threading.Thread(target=server.serve_forever, daemon=True).start()
            say(f"{file}: live view at {server.address} (Ctrl-C ends it)")
            if browser:
                webbrowser.open(server.address)
            _follow(session)
        except KeyboardInterrupt:
            say("the live view has ended")
        finally:
            session.end()
            server.shutdown()
            workers.end()


def _follow(session: Session) -> None:
    """Rebuild the design whenever the file, or a table that it reads, was saved."""
    watch = Watch(session.file)
    while True:
        changed, content = watch.look()
        if changed:
            with unbroken():  # workers start
                session.refresh(content)
        time.sleep(PAUSE)


def reporter(file: str) -> Callable[[State], None]:
    """Return a function that prints the states of a `file`, of an error only what is new."""
    printed = ""

    def report(state: State) -> None:
        nonlocal printed
        if state.error:
            complain(state.error.removeprefix(f"{printed}\n"))
        elif state.news is state.document:
            say(f"{file}: view updated")
        printed = state.error

    return report
