"""The session: the state of a file in the live view, trying numbers, and saving them."""

from __future__ import annotations

import codecs
import hashlib
import json
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import BrokenExecutor, Executor, Future
from dataclasses import dataclass, field, replace
from functools import partial
from textwrap import indent
from typing import Any, Final, TypeVar

from gearcam.base.errors import DesignError, WriteError
from gearcam.designs.design import loads
from gearcam.designs.reader import content_of, decoded
from gearcam.export.write import rewrite
from gearcam.report.page import with_draft
from gearcam.view import work
from gearcam.view.numbers import numbers, replaced

_KILLED: Final = "the process that built it was killed twice: perhaps there was no memory left"

_LARGEST: Final = 1e15
"""Largest number of a design; whole numbers beyond it are not exact."""


_T = TypeVar("_T")


class RequestError(ValueError):
    """A request of the page that cannot be fulfilled; the message says why."""


@dataclass(frozen=True, kw_only=True)
class State:
    """The state of a file.

    Parameters
    ----------
    number : int
        Number of the state, increasing.
    document : dict or None
        Last valid document; None before the first.
    news : dict or None
        Latest document or draft.
    sliders : list of dict
        Sliders of the file (see `gearcam.view.numbers.sliders`).
    made : str
        Hash of the content from which document and sliders were made.
    text : str
        That content.
    error : str
        Errors of the file since then, with remedies; empty if it is valid.
    """

    number: int = 0
    document: dict[str, Any] | None = None
    news: dict[str, Any] | None = None
    sliders: list[dict[str, Any]] = field(default_factory=list)
    made: str = ""
    text: str = ""
    error: str = ""

    @property
    def message(self) -> dict[str, Any]:
        """The state as sent to a page."""
        return {
            "number": self.number,
            "document": self.news,
            "keys": self.sliders,
            "values": numbers(self.text) if self.text else {},
            "made": self.made,
            "error": self.error,
        }


class Session:
    """A design file in the live view.

    Parameters
    ----------
    file : str
        Its name.
    workers : Executor
        Processes that build designs.
    count : int
        Number of workers.
    notice : callable
        Called with each new state.
    """

    def __init__(
        self, file: str, workers: Executor, count: int, notice: Callable[[State], None]
    ) -> None:
        self.file = file
        self.state = State()
        self.ended = False
        self._workers = workers
        self._notice = notice
        self._news = threading.Condition()
        self._newest, self._search = _Newest(count), _Newest(1)
        self._models, self._handles = _Newest(1), _Newest(1)
        self._turn = self._whole = 0

    def refresh(self, content: bytes | None) -> None:
        """Rebuild the design: first a draft if there is a document already.

        Parameters
        ----------
        content : bytes or None
            Content of the file; None if it cannot be read.
        """
        with self._news:
            self._turn += 1
            turn, first = self._turn, self.state.document is None
        if not first:
            draft = self._workers.submit(work.show_draft, content, self.file)
            draft.add_done_callback(partial(self._take_draft, turn))
        whole = self._workers.submit(work.show, content, self.file)
        whole.add_done_callback(partial(self._take, turn, content))

    def _take_draft(self, turn: int, done: Future[work.Reply]) -> None:
        reply = _result(done, self.file)
        with self._news:
            before = self.state.document
            if turn != self._turn or self._whole == turn or reply["error"] or before is None:
                return
            draft = reply["document"]
            self._set(document=with_draft(before, draft), news=draft, error="")

    def _take(self, turn: int, content: bytes | None, done: Future[work.Reply]) -> None:
        reply = _result(done, self.file)
        with self._news:
            if turn != self._turn:
                return
            self._whole = turn
            if not reply["error"] and content is not None:
                self._set(
                    document=reply["document"],
                    news=reply["document"],
                    sliders=reply["sliders"],
                    made=_hash(content),
                    text=decoded(content, self.file),
                    error="",
                )
                return
            self._set(error=reply["error"])
        if reply.get("refused") and content is not None:
            found = self._workers.submit(work.seek, decoded(content, self.file), self.file)
            found.add_done_callback(partial(self._take_remedies, turn))

    def _take_remedies(self, turn: int, done: Future[work.Reply]) -> None:
        reply = _result(done, self.file)
        with self._news:
            if turn == self._turn:
                lines = indent(reply["error"] or reply["lines"], "  ")
                self._set(error=f"{self.state.error}\n{lines}")

    def _set(self, **changes: Any) -> None:
        if self.ended:  # errors of stopped workers are no news
            return
        self.state = replace(self.state, number=self.state.number + 1, **changes)
        self._news.notify_all()
        self._notice(self.state)

    def wait(self, number: int, seconds: float) -> State:
        """Return the state once its number exceeds `number`, or after some `seconds`."""
        with self._news:
            self._news.wait_for(lambda: self.ended or self.state.number > number, seconds)
            return self.state

    def end(self) -> None:
        """End the session and all waiting for it."""
        with self._news:
            self.ended = True
            self._news.notify_all()

    def follow(self, asked: Mapping[str, Any]) -> bytes | None:
        """Return the reply to changed numbers (see `work.follow`).

        Parameters
        ----------
        asked : mapping
            ``changes``; ``last``, the key that was changed last, or several; ``exact``.

        Returns
        -------
        bytes or None
            None if overtaken by a newer request.

        Raises
        ------
        RequestError
            If ``changes`` are not numbers of the file, or ``last`` is not one of them.
        """
        state = self.state
        values, last = _values(asked.get("changes"), state), _keys(asked.get("last"))
        if not last or not {*last} <= values.keys():
            raise RequestError("last: not a key of the changes")
        exact = asked.get("exact") is True

        def reply() -> bytes:
            one = self._workers.submit(work.follow, state.text, self.file, values, last, exact)
            try:
                return one.result()
            except BrokenExecutor:
                return json.dumps({"error": f"{self.file}: {_KILLED}"}).encode()

        return self._newest.run(reply)

    def remedies(self, asked: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return remedies of a refused design with changed numbers (see `work.seek`).

        Parameters
        ----------
        asked : mapping
            ``changes``, and ``last``, the key, or keys, whose changes no remedy undoes.

        Returns
        -------
        dict or None
            None if overtaken by a newer request.

        Raises
        ------
        RequestError
            If ``changes`` are not numbers of the file.
        """
        text = replaced(self.state.text, _values(asked.get("changes"), self.state))
        given = numbers(self.state.text)
        before = {key: given[key] for key in _keys(asked.get("last")) if key in given} or None
        return self._search.run(
            lambda: _result(self._workers.submit(work.seek, text, self.file, before), self.file)
        )

    def handles(self, asked: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return what can be dragged in the picture (see `work.find_handles`).

        Parameters
        ----------
        asked : mapping
            ``changes``, which may be none; ``steps``, small changes by key; ``place``.

        Returns
        -------
        dict or None
            None if overtaken by a newer request.

        Raises
        ------
        RequestError
            If ``changes`` or ``steps`` are not numbers of the file, or ``place`` is none.
        """
        state, place = self.state, asked.get("place")
        changes = _changes(asked, state)
        steps = {key: one for key, one in _values(asked.get("steps"), state).items() if one}
        if not isinstance(place, int | float) or not abs(place) <= _LARGEST:
            raise RequestError("place: not a number")

        def found() -> work.Reply:
            asked = (state.text, self.file, changes, steps, float(place))
            return _result(self._workers.submit(work.find_handles, *asked), self.file)

        return self._handles.run(found)

    def solids(self, asked: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return a view of the solids of a design with changed numbers (see `work.solids`).

        Parameters
        ----------
        asked : mapping
            ``changes``, which may be none.

        Returns
        -------
        dict or None
            None if overtaken by a newer request.

        Raises
        ------
        RequestError
            If ``changes`` are not numbers of the file.
        """
        text = replaced(self.state.text, _changes(asked, self.state))
        return self._models.run(
            lambda: _result(self._workers.submit(work.solids, text, self.file), self.file)
        )

    def save(self, asked: Mapping[str, Any]) -> dict[str, Any]:
        """Write changed numbers into the file; comments and order are kept.

        Parameters
        ----------
        asked : mapping
            ``changes``, and ``made``: the hash of the content that they refer to.

        Returns
        -------
        dict
            ``error``, an empty text.

        Raises
        ------
        RequestError
            If the file has changed since, would not be a valid design, or cannot be written.
        """
        values, version = _values(asked.get("changes"), self.state), asked.get("made")
        try:
            content = content_of(self.file)
            if _hash(content) != version:
                raise RequestError(
                    f"nothing was written: {self.file} has changed since the page was loaded"
                )
            text = replaced(decoded(content, self.file), values)
            loads(text, file=self.file)
            mark = codecs.BOM_UTF8 if content.startswith(codecs.BOM_UTF8) else b""
            rewrite(self.file, mark + text.encode())
        except (DesignError, WriteError) as error:
            raise RequestError(f"nothing was written: {error}") from error
        return {"error": ""}


class _Newest:
    """Queue that runs only the newest waiting request; older ones are dropped.

    Parameters
    ----------
    places : int
        Number of requests that run at a time.
    """

    def __init__(self, places: int) -> None:
        self._free = threading.Condition()
        self._places = places
        self._asked = 0

    def run(self, work: Callable[[], _T]) -> _T | None:
        """Return the result of `work`, or None if a newer request came before it could start."""
        with self._free:
            self._asked += 1
            number = self._asked
            self._free.notify_all()
            self._free.wait_for(lambda: self._places > 0 or number < self._asked)
            if number < self._asked:
                return None
            self._places -= 1
        try:
            return work()
        finally:
            with self._free:
                self._places += 1
                self._free.notify_all()


def _keys(given: Any) -> list[str]:
    """Return the keys that a page has sent: one, or a list."""
    return [str(key) for key in (given if isinstance(given, list) else [given])]


def _changes(asked: Mapping[str, Any], state: State) -> dict[str, float]:
    """Return the changed numbers of a request; none is allowed."""
    changes = asked.get("changes")
    return {} if changes == {} else _values(changes, state)


def _values(changes: Any, state: State) -> dict[str, float]:
    """Return the numbers by key that a page has sent, or raise `RequestError`."""
    if not isinstance(changes, Mapping) or not changes:
        raise RequestError("changes: not numbers by key")
    values = numbers(state.text) if state.text else {}
    for key, value in changes.items():
        if key not in values:
            raise RequestError(f"changes: {key} is not a number of the file")
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise RequestError(f"{key}: not a number")
        if not abs(value) <= _LARGEST:
            raise RequestError(f"{key}: too large for a number of a design")
    return dict(changes)


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _result(done: Future[work.Reply], file: str) -> work.Reply:
    """Return the reply of a worker, or an error if it has died."""
    try:
        return done.result()
    except BrokenExecutor:
        return {"error": f"{file}: {_KILLED}"}
    except Exception as error:
        return {"error": work.fault_text(error, file)}
