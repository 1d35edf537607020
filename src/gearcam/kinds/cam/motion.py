"""The motion of a cam: an array ``[[motion]]`` of phases, or a table ``[motion]`` of the turn.

Each phase has the keys of its type and of its law. A rise and a return have a ``law`` of the
registry `gearcam.laws.motion.MOTION_LAWS`, whose parameters are further keys of the phase. The
whole turn is given by a formula, ``lift``, or by rows. `MOTION` is what all kinds take whose
designs have a motion, with its `circumstances`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from gearcam.base.rules import Breach
from gearcam.designs.faults import Fault, quoted, show
from gearcam.designs.nodes import Case, Choice, Circumstances, Either, Item, Keys, Many
from gearcam.designs.table import table_of
from gearcam.kinds.cam.forms.base import FORMS, VARIANTS
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import (
    PHASES,
    Phase,
    ReturnPhase,
    RisePhase,
    fill_half,
    program_problems,
)

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.kinds.cam.forms.base import Form
    from gearcam.laws.motion_formula import MotionFormula
    from gearcam.laws.motion_table import MotionTable

Motion: TypeAlias = "Sequence[Phase] | MotionTable | MotionFormula"
"""The motion of a cam: its phases, or that of the whole turn."""

TITLE: Final = "motion"

_MEASURED: Final = ("disc", "conjugate")
"""Forms of cams whose first profile may have been measured."""

_UNREADABLE: Final = RisePhase(angle=1.0, law=None)
"""Replaces a phase that cannot be read; as its lift is missing, sums are not checked."""


_WRONG: Final = {
    "translating": "wrong unit for the lift of a translating follower",
    "oscillating": "wrong unit for the lift of an oscillating follower",
    "turning": "the cam turns",
    "sliding": "the cam slides",
}
"""Why a key does not suit how the follower or the cam moves."""


def circumstances(document: Mapping[str, Any]) -> Circumstances:
    """Return what units of the motion depend on: the motions of cam and follower, if known."""
    follower = document.get("follower", {})
    motion = follower.get("motion", "translating") if isinstance(follower, Mapping) else None
    known = [motion] if motion in ("translating", "oscillating") else []
    return {word: _WRONG[word] for word in (*known, _form(document).moves)}


def _form(document: Mapping[str, Any]) -> type[Form[Any, Any, Any]]:
    return FORMS[VARIANTS.meant(document)]


def _follower_known(given: Circumstances) -> bool:
    return "oscillating" in given or "translating" in given


def _with_law(owner: type, needed: tuple[str, ...] = ()) -> Choice:
    return Choice(
        title=TITLE,
        tag="law",
        what="a law of rises and returns",
        entries=MOTION_LAWS,
        own=table_of(TITLE, owner),
        into="law",
        others="# Other laws of rises and returns, with example values:",
        listing="Motion laws of cams: rises and returns, in the tables [[motion]]",
        needed=needed,
    )


PHASE: Final = Choice(
    title=TITLE,
    tag="type",
    what="a phase",
    entries=PHASES,
    below={"rise": _with_law(RisePhase, ("lift",)), "return": _with_law(ReturnPhase)},
    others="# Other phases that can be used above:",
    needed=("to",),
)
"""A table ``[[motion]]``: a phase."""


def _program_problems(
    phases: Sequence[Phase | None],
    given: Circumstances,
    document: Mapping[str, Any],
) -> Iterator[Item]:
    """Yield what is wrong with the program that phases make."""
    if not _follower_known(given):
        return
    readable = [_UNREADABLE if phase is None else phase for phase in phases]
    half = _form(document).half_turns and fill_half(readable)
    yield from program_problems(
        readable, oscillating="oscillating" in given, closed="turning" in given, half=half
    )


_PHASES: Final = Many(item=PHASE, least=1, among=_program_problems)


@cache
def by_rows() -> Keys:
    """Return the keys of a motion of the whole turn that is given by rows."""
    from gearcam.laws.motion_table import MotionTable  # only where there is one

    rows = table_of(TITLE, MotionTable)
    lifts = [key for key, entry in rows.entries.items() if entry.name == "lift"]
    inline = [{"required": ["theta_deg", key]} for key in lifts]
    return Keys(
        table=rows,
        doc="rows of cam angle and lift over the turn",
        also=_turn_problems,
        rule={"oneOf": [{"required": ["file"]}, *inline]},
        examples=("file", "smoothing_tolerance_mm"),
    )


@cache
def by_formula() -> Keys:
    """Return the keys of a motion of the whole turn that is given by a formula."""
    from gearcam.laws.motion_formula import MotionFormula  # only where there is one

    table = table_of(TITLE, MotionFormula)
    return Keys(table=table, doc="the lift over the turn as a formula", also=_turn_problems)


def _turn_problems(made: Any, given: Circumstances) -> Iterator[Breach]:
    if _follower_known(given):
        yield from made.turn_problems(oscillating="oscillating" in given)


def _rule() -> str:
    types = quoted(PHASES)
    return f"[[{TITLE}]] for each phase, with type = {types}; or one [{TITLE}] with rows or lift"


def _refused(raw: Any, given: Circumstances, home: Callable[[str, Any], str]) -> Fault | None:
    """Return the fault of what is neither phases nor a motion of the turn, or None."""
    if isinstance(raw, Mapping) and "type" in raw:
        hint = "" if raw["type"] in (*PHASES,) else home("", raw["type"])
        hint = hint or f"write phases with double brackets: [[{TITLE}]]"
        return Fault((TITLE,), "is a single table", raw, _rule(), hint)
    if isinstance(raw, Mapping) and "sliding" in given:
        message = "is given over a turn, but the cam slides"
        return Fault((TITLE,), message, raw, f"[[{TITLE}]] with travel_mm")
    if isinstance(raw, Mapping) or (isinstance(raw, list) and raw):
        return None
    message = "the list is empty" if raw == [] else f"{show(raw)} is not a list of tables"
    return Fault((TITLE,), message, raw, _rule(), home("", raw))


MOTION: Final = Either(
    cases=(
        Case(
            lambda: _PHASES,
            "tuple",
            lambda raw: not isinstance(raw, Mapping),
            {},
        ),
        Case(by_formula, "MotionFormula", lambda raw: "lift" in raw, {"required": ["lift"]}),
        Case(by_rows, "MotionTable", lambda _: True, {}),
    ),
    refused=_refused,
    rule=_rule,
    doc="the lift over a turn of the cam, by phases, rows or a formula",
    others="# Instead of phases, the whole turn as rows of angle and lift, or as a formula:",
)
"""The motion of a cam."""


def of_radii(motion: Any) -> bool:
    """Return whether a motion is a measured profile: rows of radii."""
    return bool(getattr(motion, "of_radii", False))


def measured_faults(
    found: Examined, document: Mapping[str, Any], form: str, asked: Sequence[str] = ()
) -> Iterator[Fault]:
    """Yield what a measured profile does not go with.

    Parameters
    ----------
    found : Examined
        The valid tables.
    document : mapping
        All tables as in the file.
    form : str
        The form of the cam.
    asked : sequence of str
        Keys of the sizes that are to be solved for.
    """
    motion: Any = found.parts.get(TITLE)
    if not of_radii(motion):
        return
    if form not in _MEASURED:
        allowed = f"""kind = "cam" with cam.form = {" or ".join(f'"{one}"' for one in _MEASURED)}"""
        message = f"gives the radii of a profile, which a {form} cam does not have"
        yield Fault((TITLE, "file"), message, motion.file, allowed)
    for key in asked:
        yield Fault(tuple(key.split(".")), "the measured profile gives it", "solve", "a length")
    drive = document.get("drive")
    if isinstance(drive, Mapping) and drive.get("polydyne") is True:
        message = "would change the measured profile"
        yield Fault(("drive", "polydyne"), message, True, "leave it out")
