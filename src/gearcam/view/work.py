"""The tasks of workers: building a design from the text of its file.

Workers are processes, so that a long build does not block the page; arguments and replies are
pickled. A *reply* contains a ``document``, or an ``error`` in words.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from typing import Any, Final, TypeVar

from gearcam import build, remedies
from gearcam.base.errors import DesignError, GearcamError, InfeasibleError
from gearcam.base.inches import telling
from gearcam.base.interrupts import follow_parent
from gearcam.console import fault_text, quieten, refusal_text, remedy_lines
from gearcam.designs.design import Design, loads
from gearcam.designs.reader import content_of, decoded
from gearcam.numeric.arrays import keep_freed_memory
from gearcam.pictures.scenes import Scene
from gearcam.report.file import solids_shown
from gearcam.report.page import DRAFT_PLACES, document, draft
from gearcam.results.result import Result
from gearcam.view.handles import handles
from gearcam.view.numbers import Values, equals, numbers, replaced, sliders, tidy

Reply = dict[str, Any]

_T = TypeVar("_T")

_CHORDS: Final = "output.chord_tolerance_mm"

_DONE: Final = "updated"


def begin() -> None:
    """Prepare a worker: it ends with the server and ignores interrupts."""
    follow_parent()
    quieten()
    keep_freed_memory()


def show(content: bytes | None, file: str) -> Reply:
    """Return the document and the sliders of a design file.

    Parameters
    ----------
    content : bytes or None
        Content of the file; None if it cannot be read.
    file : str
        Its name.

    Returns
    -------
    dict
        ``document`` and ``sliders``, or ``error`` and ``refused``: whether the file is valid but
        the design cannot be made.
    """

    def answer() -> Reply:
        text = _text(content, file)
        design = loads(text, file=file)

        def reads(other: str) -> bool:
            try:
                loads(other, file=file)
            except DesignError:
                return False
            return True

        def moves(key: str, value: float) -> Collection[str] | None:
            return _needed(text, key, value, file)

        with telling(design.units):
            shown = document(build(design))
        return {"document": shown, "sliders": sliders(text, reads, moves)}

    return _reply(answer, file)


def _needed(text: str, key: str, value: float, file: str) -> Collection[str] | None:
    """Return which numbers have to change with one; None if no design can be made with it."""

    def made(values: Values) -> Reply:
        design = loads(replaced(text, values), file=file)
        with telling(design.units):
            build(design).coarse()
        return {"changes": values}

    try:
        reply = _first(text, {key: value}, [key], made, file)
    except Exception:  # of a value that nobody asked for: it is told once somebody does
        return None
    return None if "error" in reply else reply["changes"].keys() - {key}


def show_draft(content: bytes | None, file: str) -> Reply:
    """Return a draft of the design with this `content` of its `file`."""
    return _reply(lambda: {"document": _draft(loads(_text(content, file), file=file))}, file)


def seek(text: str, file: str, before: Values | None = None) -> Reply:
    """Search for remedies of a design that is refused.

    Parameters
    ----------
    text : str
        Of its file.
    file : str
        Its name.
    before : mapping of str to float, optional
        What a changed number was, by its key: no remedy undoes the change.

    Returns
    -------
    dict
        ``lines``, as the command line prints them; ``found``, the ``text``, the ``notes`` and the
        ``changes`` of each remedy.
    """

    def answer() -> Reply:
        sought, old = remedies(build(loads(text, file=file))), (before or {}).items()
        if old:  # what undoes the change is no remedy, and was not tried in vain
            kept = tuple(one for one in sought.found if not old <= _items(one.changes).items())
            tried = tuple(key for key in sought.tried if not key.startswith(tuple(before or ())))
            sought = replace(sought, found=kept, tried=tried)
        found = [
            {"text": one.text, "notes": one.notes, "changes": dict(one.changes)}
            for one in sought.found
        ]
        return {"lines": "\n".join(remedy_lines(sought)), "found": found}

    return _reply(answer, file)


def solids(text: str, file: str) -> Reply:
    """Make a view of the solids of a design.

    Parameters
    ----------
    text : str
        Of its file.
    file : str
        Its name.

    Returns
    -------
    dict
        As of `gearcam.report.file.solids_shown`.
    """
    return _reply(lambda: solids_shown(build(loads(text, file=file))), file)


def find_handles(text: str, file: str, changes: Values, steps: Values, place: float) -> Reply:
    """Find what can be dragged in the picture.

    Parameters
    ----------
    text : str
        Text of the design file.
    file : str
        Its name.
    changes : mapping of str to float
        New values by key.
    steps : mapping of str to float
        Small changes of the numbers that may move, by key.
    place : float
        Place of the driver, in the unit of the scene.

    Returns
    -------
    dict
        ``handles`` (see `gearcam.view.handles.handles`).
    """

    def drawn(values: Values) -> Scene | None:
        return _coarsely(
            loads(replaced(text, values), file=file),
            lambda result: result.plain.scene(DRAFT_PLACES),
        )

    return _reply(lambda: {"handles": handles(drawn, numbers(text), changes, steps, place)}, file)


def follow(text: str, file: str, changes: Values, last: Collection[str], exact: bool) -> bytes:
    """Return the document of a design file with changed numbers, and with others if required.

    Some numbers cannot change alone, such as the first ratio of a closed law, which equals the
    last. If the design is refused, equal numbers of the same list are changed too; then the first
    remedy that the refusal names and that does not change any of `last` is tried.

    Parameters
    ----------
    text : str
        Text of the design file.
    file : str
        Its name.
    changes : mapping of str to float
        New values by key.
    last : collection of str
        The keys that were changed last; their values are kept.
    exact : bool
        Whether to return the whole document instead of a draft.

    Returns
    -------
    bytes
        A reply as JSON, with all ``changes`` that were made. If the design is refused, its
        ``error`` says why; where other numbers have to follow and lead to another reason, it gives
        that one, and ``changes`` has those numbers too.
    """

    def answer(values: Values) -> Reply:
        design = loads(replaced(text, values), file=file)
        with telling(design.units):
            content = document(build(design)) if exact else _draft(design)
        return {"document": content, "changes": dict(values)}

    reply = _reply(lambda: _first(text, changes, last, answer, file), file)
    return json.dumps(reply, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()


def _first(
    text: str,
    changes: Values,
    last: Collection[str],
    answer: Callable[[Values], Reply],
    file: str,
) -> Reply:
    """Return the reply for the changes alone or, if refused, together with required ones."""
    values = numbers(text)
    refusals: list[tuple[Values, DesignError | InfeasibleError]] = []

    def required() -> Iterator[Values]:
        """Yield what to change too: nothing, equal numbers, what each refusal names."""
        yield {}
        equal = {key: one for own in last for key, one in equals(values, own, changes[own]).items()}
        if equal := {key: one for key, one in equal.items() if key not in last}:
            yield equal
        for more, error in tuple(refusals):
            ways = (_items(way.near) for way in getattr(error, "adjustments", ()))
            fit = (
                way
                for way in ways
                if way and not way.keys() & {*last} and way.keys() <= values.keys()
            )
            if near := next(fit, None):
                yield {**more, **near}

    for more in required():
        try:
            return answer({**changes, **more})
        except (DesignError, InfeasibleError) as error:
            refusals.append((more, error))
    reason = getattr(refusals[0][1], "what", "")
    others = (
        (more, error)
        for more, error in refusals[:0:-1]
        if isinstance(error, InfeasibleError) and error.what != reason
    )
    more, error = next(others, refusals[0])
    return {**_refusal(error, file), "changes": {**changes, **more}}


def _items(near: Mapping[str, Any]) -> dict[str, Any]:
    """Return changes with one key for each item of a list, numbers rounded."""
    changes: dict[str, Any] = {}
    for key, value in near.items():
        items = enumerate(value) if isinstance(value, list | tuple) else ()
        changes |= {f"{key}[{k}]": item for k, item in items} or {key: value}
    return {key: tidy(one) if isinstance(one, float) else one for key, one in changes.items()}


def _draft(design: Design) -> Reply:
    return _coarsely(design, draft)


def _coarsely(design: Design, make: Callable[[Result], _T]) -> _T:
    """Return what `make` makes of a design with coarse chords."""
    result = build(design)
    with telling(design.units):
        try:
            return make(result.coarse())
        except InfeasibleError as error:
            if _CHORDS not in str(error):
                raise
        return make(result)  # the teeth are too small for coarse chords


def _text(content: bytes | None, file: str) -> str:
    return decoded(content_of(file) if content is None else content, file)


def _reply(work: Callable[[], Reply], file: str) -> Reply:
    """Return the reply of `work`, or the error as the command line prints it."""
    try:
        return {"error": "", **work()}
    except (DesignError, InfeasibleError) as error:
        return _refusal(error, file)
    except GearcamError as error:
        return {"error": f"{file}: {error}"}
    except Exception as error:
        return {"error": fault_text(error, file)}


def _refusal(error: DesignError | InfeasibleError, file: str) -> Reply:
    """Return the reply for a design that is not valid or cannot be made."""
    refused = isinstance(error, InfeasibleError)
    return {"error": refusal_text(error, file, _DONE), "refused": refused}
