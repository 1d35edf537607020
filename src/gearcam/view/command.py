"""The command ``view``: serves, watches, and says what it does until it is interrupted."""

from __future__ import annotations

import os
import threading
import time
import webbrowser
from argparse import ArgumentParser
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import active_children, get_context
from typing import Final

from gearcam.console import complain, say
from gearcam.designs.reader import content_of
from gearcam.interrupts import unbroken
from gearcam.view.server import Server
from gearcam.view.session import Session, State
from gearcam.view.watch import PAUSE, Watch
from gearcam.view.work import begin

_WORKERS: Final = range(2, 5)
"""A draft is built while another, or the whole document, still is; more than four help nobody."""


def arguments(parser: ArgumentParser) -> None:
    """Add the command's file and options to a `parser`."""
    parser.add_argument("file", metavar="FILE", help="design file (TOML)")
    words = "port of the page (default: any free port)"
    parser.add_argument("--port", type=int, default=0, metavar="N", help=words)
    words = "print the address without opening a browser"
    parser.add_argument("--no-browser", action="store_true", help=words)


def view(file: str, port: int = 0, *, browser: bool = True) -> None:
    """Show a design's page, and follow its file, until it is interrupted (Ctrl-C).

    Parameters
    ----------
    file : str
        A design file; one with errors is shown when it is mended.
    port : int
        Where; 0 takes a free one.
    browser : bool
        Whether a browser is opened.

    Raises
    ------
    DesignError
        If the file is not there, or the port cannot be used.
    """
    content_of(file)
    count = min(max(os.cpu_count() or 1, _WORKERS.start), _WORKERS.stop - 1)
    context = get_context("spawn")  # threads of a server do not survive a fork
    with ProcessPoolExecutor(count, mp_context=context, initializer=begin) as workers:
        session = Session(file, workers, count, lambda state: _tell(file, state))
        with Server(session, port) as server:
            try:
                with unbroken():
                    threading.Thread(target=server.serve_forever, daemon=True).start()
                say(f"{file}: shown at {server.address} until Ctrl-C")
                if browser:
                    webbrowser.open(server.address)
                _follow(session)
            except KeyboardInterrupt:
                say("the view has ended")
            finally:
                session.end()
                server.shutdown()
                workers.shutdown(wait=False, cancel_futures=True)
                for worker in active_children():  # one that still builds would be waited for
                    worker.kill()


def _follow(session: Session) -> None:
    """Have the file built anew whenever it, or a table that it reads, has been saved."""
    watch = Watch(session.file)
    while True:
        changed, content = watch.look()
        if changed:
            with unbroken():  # workers begin
                session.refresh(content)
        time.sleep(PAUSE)


def _tell(file: str, state: State) -> None:
    if state.error:
        complain(state.error)
    elif state.news is state.document:
        say(f"{file}: shown")
