"""The motion of a cam: an array ``[[motion]]`` of phases, or a table ``[motion]`` of the turn.

Each phase has the keys of its type and of its law. A rise and a return have a ``law`` of the
registry `gearcam.laws.rises.base.RISES`, whose parameters are further keys of the phase. The whole
turn is given by a formula, ``lift``, or by rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.registry import name_of
from gearcam.designs.examine import chosen
from gearcam.designs.faults import Fault, quoted, show
from gearcam.designs.kind import Examined
from gearcam.designs.lines import Path
from gearcam.designs.slips import misspelt
from gearcam.designs.table import Table, table_of
from gearcam.designs.validate import faults_of, made_of, told_faults
from gearcam.kinds.cam.forms.base import SLIDING, form_of
from gearcam.laws.phases_of_lift import PHASES, Phase, RisePhase, fill_half, program_problems
from gearcam.laws.rises.base import RISES

if TYPE_CHECKING:
    from gearcam.laws.motion_formula import MotionFormula
    from gearcam.laws.motion_table import MotionTable

    Motion = Sequence[Phase] | MotionTable | MotionFormula

TITLE: Final = "motion"

WITH_LAW: Final = tuple(name for name, owner in PHASES.items() if issubclass(owner, RisePhase))
"""The phases that have a law."""

LIFT: Final = {"rise": "lift", "segment": "to"}
"""Required key of a phase, a length or an angle, without the suffix of its unit."""

SPAN: Final = "angle"
"""Key of every phase: an angle, or a travel if the cam slides."""

_UNREADABLE: Final = RisePhase(angle=1.0, law=None)
"""Replaces a phase that cannot be read; as its lift is missing, sums are not checked."""


@cache
def phase_table(name: str, law: str = "") -> Table:
    """Return the table of a phase, without the keys ``type`` and ``law``.

    Parameters
    ----------
    name : str
        Its type.
    law : str
        Its law; its parameters follow the phase's own keys.

    Returns
    -------
    Table
    """
    own = table_of(TITLE, PHASES[name])
    return Table(TITLE, None, {**own.entries, **rise_table(law).entries}) if law else own


def rise_table(law: str) -> Table:
    """Return the table of a law's parameters."""
    return table_of(TITLE, RISES[law].parameters)


def twins(known: Table) -> dict[str, tuple[str, ...]]:
    """Return the keys of each field that can be a length or an angle."""
    words: dict[str, list[str]] = {}
    for key, entry in known.entries.items():
        words.setdefault(entry.name, []).append(key)
    return {word: tuple(keys) for word, keys in words.items() if len(keys) > 1}


def summary(phase: type) -> str:
    """Return a short description of a phase."""
    first = (phase.__doc__ or "").partition("\n")[0].rstrip(".")
    return first[:1].lower() + first[1:]


def examine_motion(
    document: Mapping[str, Any], found: Examined, home: Callable[[str], str]
) -> None:
    """Examine the motion of a document, and the program that its phases or rows make.

    Parameters
    ----------
    document : mapping
        As read from TOML.
    found : Examined
        Gets the faults, or ``motion``.
    home : callable
        Gives the words that say where a key of another place belongs.
    """
    raw = document.get(TITLE)
    types = quoted(PHASES)
    rule = f"[[{TITLE}]] for each phase, with type = {types}; or one [{TITLE}] with rows or lift"
    oscillating = _oscillating(document.get("follower", {}))
    sliding = _sliding(document.get("cam", {}))
    if TITLE not in document:
        found.faults.append(Fault((TITLE,), "is missing", allowed=rule))
    elif isinstance(raw, Mapping) and "type" in raw:
        hint = f"write phases with double brackets: [[{TITLE}]]"
        found.faults.append(Fault((TITLE,), "is a single table", raw, rule, hint))
    elif isinstance(raw, Mapping) and sliding:
        message = "is given over a turn, but the cam slides"
        found.faults.append(Fault((TITLE,), message, raw, f"[[{TITLE}]] with way_mm"))
    elif isinstance(raw, Mapping):
        _examine_turn(raw, oscillating, found, home)
    elif not isinstance(raw, list) or not raw:
        message = "the list is empty" if raw == [] else f"{show(raw)} is not a list of tables"
        found.faults.append(Fault((TITLE,), message, raw, rule))
    else:
        before = len(found.faults)
        kind = (oscillating, sliding)
        phases = [_phase((TITLE, k), item, kind, found, home) for k, item in enumerate(raw)]
        _examine_program(phases, raw, kind, found, half=form_of(document).half_turns)
        if len(found.faults) == before:
            found.parts[TITLE] = tuple(phases)


def _oscillating(follower: Any) -> bool | None:
    """Return whether a follower oscillates; None if its table does not say."""
    motion = follower.get("motion", "translating") if isinstance(follower, Mapping) else None
    return motion == "oscillating" if motion in ("translating", "oscillating") else None


def _sliding(cam: Any) -> bool:
    """Return whether a cam slides; False for unknown forms."""
    form = cam.get("form") if isinstance(cam, Mapping) else None
    return form in SLIDING


def _by_rows() -> type[MotionTable]:
    from gearcam.laws.motion_table import MotionTable  # only where there is one

    return MotionTable


def _by_formula() -> type[MotionFormula]:
    from gearcam.laws.motion_formula import MotionFormula  # only where there is one

    return MotionFormula


def whole_turns() -> tuple[type[MotionTable], type[MotionFormula]]:
    """Return the classes of motions that are given for the whole turn."""
    return _by_rows(), _by_formula()


def turn_tables() -> tuple[Table, Table]:
    """Return their tables: by rows, and by a formula."""
    rows, formula = (table_of(TITLE, owner) for owner in whole_turns())
    return rows, formula


def _examine_turn(
    raw: Mapping[str, Any], oscillating: bool | None, found: Examined, home: Callable[[str], str]
) -> None:
    owner = _by_formula() if "lift" in raw else _by_rows()
    known = table_of(TITLE, owner)
    faults = list(faults_of(known, raw, home=home))
    other = list(_wrong_kind(known, raw, (TITLE,), oscillating))
    found.faults += [*faults, *other]
    if other or oscillating is None:
        return
    known = known.of_lifts(oscillating=oscillating)
    made, problems = made_of(known, owner, raw, faults, (TITLE,))
    if not faults and not problems:
        told = made.turn_problems(oscillating=oscillating)
        problems = list(told_faults(told, known, raw, (TITLE,)))
        found.parts[TITLE] = made
    found.faults += problems


def _phase(
    at: Path,
    raw: Any,
    kind: tuple[bool | None, bool],
    found: Examined,
    home: Callable[[str], str],
) -> Phase | None:
    """Examine one phase and return what can be read of it, to check the program.

    `kind` is whether the follower oscillates and whether the cam slides.
    """
    oscillating, sliding = kind
    if not isinstance(raw, Mapping):
        rule = f"a table with type = {quoted(PHASES)}"
        found.faults.append(Fault(at, f"{show(raw)} is not a table", raw, rule))
        return None
    name, right = chosen(at, raw, "type", "a phase", PHASES, found)
    if not name:
        return None
    rest = {key: value for key, value in raw.items() if key != "type"}
    spans = list(_wrong_span(phase_table(name), rest, at, sliding))
    rest = {key: value for key, value in rest.items() if all(key != one.path[-1] for one in spans)}
    own, make, problems = phase_table(name).of_cams(sliding=sliding), PHASES[name], []
    if name not in WITH_LAW:
        faults = list(faults_of(own, rest, home=home, at=at, listed=_told(own, oscillating)))
    else:
        chose, _ = chosen(at, raw, "law", "a law of rises and returns", RISES, found)
        rest.pop("law", None)
        if not chose:  # it may be a key of any law
            rest = {k: value for k, value in rest.items() if k in own.entries or not _asked(k)}
        known = phase_table(name, chose).of_cams(sliding=sliding)
        told = _told(known, oscillating, "law")
        faults = list(faults_of(known, rest, home=home, at=at, listed=told))
        law = None
        if chose:
            law, problems = made_of(rise_table(chose), RISES[chose].parameters, rest, faults, at)
        make = partial(make, law=law)
    if spans:  # in place of what is missing
        faults = [one for one in faults if one.path[-1] not in ("way_mm", "angle_deg")] + spans
    other = list(_wrong_kind(own, rest, at, oscillating))
    own = own.of_lifts(oscillating=bool(oscillating))
    phase, own_problems = made_of(own, make, rest, faults, at)
    told = [*faults, *problems, *own_problems, *other]
    found.faults += [one for one in told if right or one.path[len(at)] in raw]
    return None if other or spans or not right else phase


def _told(known: Table, oscillating: bool | None, *chosen: str) -> list[str]:
    """Return the keys of a phase for messages: lifts for its kind of follower only."""
    of_kind = [
        key
        for key, entry in known.entries.items()
        if oscillating is None or entry.swings is not (not oscillating)
    ]
    return ["type", *chosen, *of_kind]


def _wrong_span(known: Table, raw: Mapping[str, Any], at: Path, sliding: bool) -> Iterator[Fault]:
    """Yield the faults of angles if the cam slides, and of travels if it turns."""
    for key, entry in known.entries.items():
        if key not in raw:
            continue
        if entry.slides is (not sliding):
            message, rule = ("turns", "angle_deg") if entry.slides else ("slides", "way_mm")
            yield Fault((*at, key), f"{show(raw[key])}: the cam {message}", raw[key], rule)
        elif sliding and "_per_rad" in key:
            message = f"{show(raw[key])}: segments of a cam that slides end at rest"
            yield Fault((*at, key), message, raw[key], "leave it out")


def _wrong_kind(
    known: Table, raw: Mapping[str, Any], at: Path, oscillating: bool | None
) -> Iterator[Fault]:
    """Yield the faults of lengths for an oscillating follower, and of angles for a translating."""
    kind, unit = ("an oscillating", "_deg") if oscillating else ("a translating", "_mm")
    for key, entry in known.entries.items():
        if key in raw and oscillating is not None and entry.swings is (not oscillating):
            message = f"{show(raw[key])}: wrong unit for the lift of {kind} follower"
            yield Fault((*at, key), message, raw[key], f"the key that ends in {unit}")


def _asked(key: str) -> bool:
    return any(key in rise_table(law).entries for law in RISES)


def _examine_program(
    phases: Sequence[Phase | None],
    raw: Sequence[Any],
    kind: tuple[bool | None, bool],
    found: Examined,
    *,
    half: bool,
) -> None:
    oscillating, sliding = kind
    if oscillating is None:
        return
    readable = [_UNREADABLE if phase is None else phase for phase in phases]
    told = program_problems(
        readable,
        oscillating=oscillating,
        closed=not sliding,
        half=half and fill_half(readable),
    )
    for number, name, message, rule in told:
        if number is None:
            found.faults.append(Fault((TITLE,), message, allowed=rule))
        elif phases[number] is not None:
            known = phase_table(raw[number]["type"]).of_cams(sliding=sliding)
            known = known.of_lifts(oscillating=oscillating)
            faults = told_faults([(name, None, message, rule)], known, raw[number], (TITLE, number))
            meant = misspelt(raw[number], known.entries)  # the unknown key is reported instead
            found.faults += [one for one in faults if one.path[2] not in meant]


def motion_of(
    motion: Motion, *, oscillating: bool, sliding: bool = False
) -> list[dict[str, Any]] | dict[str, Any]:
    """Return what a file would hold of a motion: a table for each phase, or one for the turn.

    Parameters
    ----------
    motion : tuple of Phase, MotionTable or MotionFormula
        As a design has it.
    oscillating : bool
        Whether lifts are angles.
    sliding : bool
        Whether the cam slides.

    Returns
    -------
    list of dict, or dict
    """
    if not isinstance(motion, Sequence):
        return table_of(TITLE, type(motion)).of_lifts(oscillating=oscillating).document(motion)
    names = {owner: name for name, owner in PHASES.items()}
    tables = []
    for phase in motion:
        name = names[type(phase)]
        table: dict[str, Any] = {"type": name}
        law = name_of(RISES, phase.law) if isinstance(phase, RisePhase) else ""
        if law:
            table |= {"law": law}
        known = phase_table(name).of_cams(sliding=sliding).of_lifts(oscillating=oscillating)
        table |= known.document(phase)
        if isinstance(phase, RisePhase) and law:
            table |= rise_table(law).document(phase.law)
        tables.append(table)
    return tables


def homes() -> dict[str, str]:
    """Return in words where the keys of a motion belong."""
    by_phase: dict[str, list[str]] = {"law": list(WITH_LAW)}
    for name in PHASES:
        for key in phase_table(name).entries:
            by_phase.setdefault(key, []).append(name)
    by_law: dict[str, list[str]] = {}
    for law in RISES:
        for key in rise_table(law).entries:
            by_law.setdefault(key, []).append(law)
    found = {key: f"with law = {quoted(laws)}" for key, laws in by_law.items()}
    found |= {key: f"of type {quoted(names)}" for key, names in by_phase.items()}
    told = {key: f"this key belongs under [[{TITLE}]] {words}" for key, words in found.items()}
    turns = (key for known in turn_tables() for key in known.entries)
    return dict.fromkeys(turns, f"this key belongs under [{TITLE}]") | told
