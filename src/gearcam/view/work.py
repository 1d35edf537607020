"""What workers do: have a text built, and tell what came of it.

Workers are processes, so that a build that takes long keeps nobody waiting; what goes to them and
what comes back pickles. A *reply* holds a ``document``, or an ``error`` in words.
"""

from __future__ import annotations

import json
import os
import signal
import threading
from collections.abc import Callable, Mapping
from multiprocessing import connection, parent_process
from typing import Any, Final

from gearcam import build, remedies
from gearcam.console import fault_text, quieten, refusal_text, remedy_lines
from gearcam.designs.design import Design
from gearcam.designs.reader import content_of, decoded, loads
from gearcam.errors import DesignError, GearcamError, InfeasibleError
from gearcam.interrupts import SIGNALS
from gearcam.numeric.memory import keep_freed_memory
from gearcam.report.page import document, draft
from gearcam.view.numbers import Values, equals, numbers, replaced, sliders, tidy

Reply = dict[str, Any]

COARSE: Final = 0.02
"""Chord error of a draft, mm: a fifth of a pixel where 100 mm fill a thousand of them."""

_CHORDS: Final = "output.chord_tolerance_mm"

_DONE: Final = "updated"


def begin() -> None:
    """Prepare a worker: who ends the server ends it too, and no interrupt is its to answer."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    quieten()
    keep_freed_memory()
    parent = parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    connection.wait([sentinel])
    os._exit(0)


def show(content: bytes | None, file: str) -> Reply:
    """Return all that a page shows of a design file.

    Parameters
    ----------
    content : bytes or None
        What it holds; None where it cannot be read.
    file : str
        Its name.

    Returns
    -------
    dict
        ``document`` and ``sliders``, or ``error`` and whether the design was ``refused`` by
        computing.
    """

    def made() -> Reply:
        text = _text(content, file)
        design = loads(text, file=file)

        def reads(other: str) -> bool:
            try:
                loads(other, file=file)
            except DesignError:
                return False
            return True

        return {"document": document(build(design)), "sliders": sliders(text, reads)}

    return _told(made, file)


def show_draft(content: bytes | None, file: str) -> Reply:
    """Return a draft of a design file; parameters as of `show` (see `show`)."""
    return _told(lambda: {"document": _draft(loads(_text(content, file), file=file))}, file)


def seek(text: str, file: str) -> Reply:
    """Search for remedies of a design that is refused.

    Parameters
    ----------
    text : str
        Of its file.
    file : str
        Its name.

    Returns
    -------
    dict
        ``lines``, as the command line prints them; ``found``, for each remedy its ``text`` and its
        ``changes``, numbers by key, null where it changes more than numbers of the file.
    """

    def made() -> Reply:
        sought, known = remedies(build(loads(text, file=file))), numbers(text)
        found = [(one.text, _items(one.changes)) for one in sought.found]
        return {
            "lines": "\n".join(remedy_lines(sought)),
            "found": [
                {"text": words, "changes": changes if changes.keys() <= known.keys() else None}
                for words, changes in found
            ],
        }

    return _told(made, file)


def follow(text: str, file: str, changes: Values, last: str, exact: bool) -> bytes:
    """Return what comes of a text with other numbers, and of others that have to follow.

    A number may not change alone: the first and the last of a list are the same, a law closes. What
    the refusal asks for is then tried: the numbers of its list that are equal to it, and the first
    of the ways that the refusal names and that leave it as it is.

    Parameters
    ----------
    text : str
        Of the design file.
    file : str
        Its name.
    changes : mapping of str to float
        By key.
    last : str
        The key that was changed last, and stays.
    exact : bool
        Whether all of the document is wanted, or a draft.

    Returns
    -------
    bytes
        A reply as JSON, with the ``changes`` that were shown.
    """

    def shown(values: Values) -> Reply:
        design = loads(replaced(text, values), file=file)
        made = document(build(design)) if exact else _draft(design)
        return {"document": made, "changes": dict(values)}

    reply = _told(lambda: _first(text, changes, last, shown), file)
    return json.dumps(reply, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()


def _first(text: str, changes: Values, last: str, shown: Callable[[Values], Reply]) -> Reply:
    """Return the first that can be shown of the changes alone and with what else may have to be."""
    found = numbers(text)
    refusals: list[DesignError | InfeasibleError] = []
    for more in ({}, equals(found, last, changes[last])):
        if more or not refusals:
            try:
                return shown({**changes, **more})
            except (DesignError, InfeasibleError) as error:
                refusals.append(error)
    for way in (way for error in refusals for way in getattr(error, "ways", ())):
        near = _items(way.near)
        if near and last not in near and near.keys() <= found.keys():
            own = equals(found, last, changes[last]) if len(refusals) > 1 else {}
            try:
                return shown({**changes, **own, **near})
            except (DesignError, InfeasibleError):
                break
    raise refusals[0]


def _items(near: Mapping[str, Any]) -> dict[str, Any]:
    """Return a change with the items of its lists one by one, and no needless digits."""
    made: dict[str, Any] = {}
    for key, value in near.items():
        items = enumerate(value) if isinstance(value, list | tuple) else ()
        made |= {f"{key}[{k}]": item for k, item in items} or {key: value}
    return {key: tidy(one) if isinstance(one, float) else one for key, one in made.items()}


def _draft(design: Design) -> Reply:
    try:
        return draft(build(design.with_({_CHORDS: COARSE})))
    except (DesignError, InfeasibleError) as error:
        if _CHORDS not in str(error):
            raise
    return draft(build(design))  # whose teeth are too small for coarse chords


def _text(content: bytes | None, file: str) -> str:
    return decoded(content_of(file) if content is None else content, file)


def _told(work: Callable[[], Reply], file: str) -> Reply:
    """Return a reply, or the words for what went wrong, as the command line tells it."""
    try:
        return {"error": "", **work()}
    except (DesignError, InfeasibleError) as error:
        refused = isinstance(error, InfeasibleError)
        return {"error": refusal_text(error, file, _DONE), "refused": refused}
    except GearcamError as error:
        return {"error": f"{file}: {error}"}
    except Exception as error:
        return {"error": fault_text(error, file)}
