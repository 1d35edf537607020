"""The motion of a cam: an array ``[[motion]]`` of phases, or a table ``[motion]`` of the turn.

Each phase has the keys of its type and of its law. A rise and a return have a ``law`` of the
registry `gearcam.laws.motion.base.MOTION_LAWS`, whose parameters are further keys of the phase. The
whole turn is given by a formula, ``lift``, or by rows.

`MOTION` is what all kinds take whose designs have a motion.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from gearcam.base.quantities import OPPOSITES
from gearcam.base.registry import classes_in, deferred, name_of
from gearcam.designs.design import Wanted
from gearcam.designs.examine import chosen, home_of
from gearcam.designs.faults import Fault, quoted, show
from gearcam.designs.kind import KINDS, Examined, Main
from gearcam.designs.lines import Path
from gearcam.designs.slips import misspelt
from gearcam.designs.table import Table, table_of
from gearcam.designs.validate import faults_of, parameters_of, placed_faults
from gearcam.kinds.cam.forms.base import FORMS, VARIANTS
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.laws.phases_of_lift import PHASES, Phase, RisePhase, fill_half, program_problems

if TYPE_CHECKING:
    from gearcam.kinds.cam.forms.base import Form
    from gearcam.laws.motion_formula import MotionFormula
    from gearcam.laws.motion_table import MotionTable

Motion: TypeAlias = "Sequence[Phase] | MotionTable | MotionFormula"
"""The motion of a cam: its phases, or that of the whole turn."""

TITLE: Final = "motion"

WITH_LAW: Final = tuple(name for name, owner in PHASES.items() if issubclass(owner, RisePhase))
"""The phases that have a law."""

LIFT: Final = {"rise": "lift", "segment": "to"}
"""Required key of a phase, a length or an angle, without the suffix of its unit."""

SPAN: Final = "angle"
"""Key of every phase: an angle, or a travel if the cam slides."""

Circumstances = tuple[str, ...]
"""Some of `gearcam.base.quantities.OPPOSITES`: the motion of the follower, and that of the cam."""

_WRONG: Final = {
    "translating": "wrong unit for the lift of a translating follower",
    "oscillating": "wrong unit for the lift of an oscillating follower",
    "turning": "the cam turns",
    "sliding": "the cam slides",
}
"""Why a key does not suit the circumstances."""

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
    return table_of(TITLE, MOTION_LAWS[law].parameters)


def summary(phase: type) -> str:
    """Return a short description of a phase."""
    first = (phase.__doc__ or "").partition("\n")[0].rstrip(".")
    return first[:1].lower() + first[1:]


def examine_motion(document: Mapping[str, Any], found: Examined) -> None:
    """Examine the motion of a document, and the program that its phases or rows make.

    Parameters
    ----------
    document : mapping
        As read from TOML.
    found : Examined
        Gets the faults, or ``motion``.
    """
    raw, given = document.get(TITLE), circumstances(document)
    types = quoted(PHASES)
    rule = f"[[{TITLE}]] for each phase, with type = {types}; or one [{TITLE}] with rows or lift"
    if TITLE not in document:
        found.faults.append(Fault((TITLE,), "is missing", allowed=rule))
    elif isinstance(raw, Mapping) and "type" in raw:
        hint = "" if raw["type"] in (*PHASES,) else _home("", raw["type"])
        hint = hint or f"write phases with double brackets: [[{TITLE}]]"
        found.faults.append(Fault((TITLE,), "is a single table", raw, rule, hint))
    elif isinstance(raw, Mapping) and "sliding" in given:
        message = "is given over a turn, but the cam slides"
        found.faults.append(Fault((TITLE,), message, raw, f"[[{TITLE}]] with travel_mm"))
    elif isinstance(raw, Mapping):
        _examine_turn(raw, given, found)
    elif not isinstance(raw, list) or not raw:
        message = "the list is empty" if raw == [] else f"{show(raw)} is not a list of tables"
        found.faults.append(Fault((TITLE,), message, raw, rule, _home("", raw)))
    else:
        before = len(found.faults)
        phases = [_phase((TITLE, k), item, given, found) for k, item in enumerate(raw)]
        _examine_program(phases, raw, given, found, half=_form(document).half_turns)
        if len(found.faults) == before:
            found.parts[TITLE] = tuple(phases)


def circumstances(document: Mapping[str, Any]) -> tuple[str, ...]:
    """Return what units of the motion depend on: the motions of cam and follower, if known."""
    follower = document.get("follower", {})
    motion = follower.get("motion", "translating") if isinstance(follower, Mapping) else None
    known = (motion,) if motion in ("translating", "oscillating") else ()
    return (*known, _form(document).moves)


def _home(key: str, value: Any) -> str:
    return home_of(KINDS["cam"], key, value)


def _form(document: Mapping[str, Any]) -> type[Form[Any, Any, Any]]:
    return FORMS[VARIANTS.meant(document)]


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


def _examine_turn(raw: Mapping[str, Any], given: Circumstances, found: Examined) -> None:
    owner = _by_formula() if "lift" in raw else _by_rows()
    known = table_of(TITLE, owner)
    wrong = list(_wrong_units(known, raw, (TITLE,), given))
    known, rest = known.bound(given), _without(raw, wrong)
    faults = list(faults_of(known, rest, home=_home))
    found.faults += [*faults, *wrong]
    if wrong or not _follower_known(given):
        return
    made, problems = parameters_of(known, owner, raw, faults, (TITLE,))
    if not faults and not problems:
        faults_of_turn = made.turn_problems(oscillating="oscillating" in given)
        problems = list(placed_faults(faults_of_turn, known, raw, (TITLE,)))
        found.parts[TITLE] = made
    found.faults += problems


def _phase(at: Path, raw: Any, given: Circumstances, found: Examined) -> Phase | None:
    """Examine one phase and return what can be read of it, to check the program."""
    if not isinstance(raw, Mapping):
        rule = f"a table with type = {quoted(PHASES)}"
        found.faults.append(Fault(at, f"{show(raw)} is not a table", raw, rule))
        return None
    name, right = chosen(at, raw, "type", "a phase", PHASES, found)
    if not name:
        return None
    choices, law, make = ["type"], "", PHASES[name]
    if name in WITH_LAW:
        choices.append("law")
        law, _ = chosen(at, raw, "law", "a law of rises and returns", MOTION_LAWS, found)
    rest = {key: value for key, value in raw.items() if key not in choices}
    own, known = phase_table(name), phase_table(name, law)
    wrong = list(_wrong_units(known, rest, at, given))
    own, known, rest = own.bound(given), known.bound(given), _without(rest, wrong)
    if name in WITH_LAW and not law:  # it may be a key of any law
        rest = {k: value for k, value in rest.items() if k in own.entries or not _asked(k)}
    replaced = {one.allowed for one in wrong}  # these are not missing besides
    faults = [
        one
        for one in faults_of(known, rest, home=_home, at=at, listed=[*choices, *known.entries])
        if one.path[-1] not in replaced
    ]
    phase, problems = None, list[Fault]()
    if law:
        parameters, problems = parameters_of(
            rise_table(law), MOTION_LAWS[law].parameters, rest, faults, at
        )
        make = partial(make, law=parameters)
    elif name in WITH_LAW:
        make = partial(make, law=None)
    if not wrong:
        phase, more = parameters_of(own, make, rest, faults, at)
        problems += more
    every = [*faults, *problems, *wrong]
    found.faults += [one for one in every if right or one.path[len(at)] in raw]
    return phase if right else None


def _wrong_units(
    known: Table, raw: Mapping[str, Any], at: Path, given: Circumstances
) -> Iterator[Fault]:
    """Yield the faults of keys for other circumstances, each with the right key."""
    right = {entry.name: key for key, entry in known.bound(given).entries.items()}
    for key, entry in known.entries.items():
        if key in raw and (
            against := [OPPOSITES[one] for one in entry.param.when if OPPOSITES[one] in given]
        ):
            words, rule = _WRONG[against[0]], right.get(entry.name, "leave it out")
            if entry.name not in right:
                words = "segments of a cam that slides end at rest"
            yield Fault((*at, key), f"{show(raw[key])}: {words}", raw[key], rule)


def _without(raw: Mapping[str, Any], faults: Sequence[Fault]) -> dict[str, Any]:
    wrong = {one.path[-1] for one in faults}
    return {key: value for key, value in raw.items() if key not in wrong}


def _follower_known(given: Circumstances) -> bool:
    return "oscillating" in given or "translating" in given


def _asked(key: str) -> bool:
    return any(key in rise_table(law).entries for law in MOTION_LAWS)


def _examine_program(
    phases: Sequence[Phase | None],
    raw: Sequence[Any],
    given: Circumstances,
    found: Examined,
    *,
    half: bool,
) -> None:
    if not _follower_known(given):
        return
    readable = [_UNREADABLE if phase is None else phase for phase in phases]
    broken = program_problems(
        readable,
        oscillating="oscillating" in given,
        closed="turning" in given,
        half=half and fill_half(readable),
    )
    for number, name, message, rule in broken:
        if number is None:
            found.faults.append(Fault((TITLE,), message, allowed=rule))
        elif phases[number] is not None:
            known = phase_table(raw[number]["type"]).bound(given)
            faults = placed_faults(
                [(name, None, message, rule)], known, raw[number], (TITLE, number)
            )
            meant = misspelt(raw[number], known.entries)  # the unknown key is reported instead
            found.faults += [one for one in faults if one.path[2] not in meant]


def motion_of(motion: Motion, given: Circumstances) -> list[dict[str, Any]] | dict[str, Any]:
    """Return what a file would hold of a motion: a table for each phase, or one for the turn.

    Parameters
    ----------
    motion : tuple of Phase, MotionTable or MotionFormula
        As a design has it.
    given : tuple of str
        See `circumstances`.

    Returns
    -------
    list of dict, or dict
    """
    if not isinstance(motion, Sequence):
        return table_of(TITLE, type(motion)).bound(given).document(motion)
    names = {owner: name for name, owner in PHASES.items()}
    tables = []
    for phase in motion:
        name = names[type(phase)]
        table: dict[str, Any] = {"type": name}
        law = name_of(MOTION_LAWS, phase.law) if isinstance(phase, RisePhase) else ""
        if law:
            table |= {"law": law}
        table |= phase_table(name).bound(given).document(phase)
        if isinstance(phase, RisePhase) and law:
            table |= rise_table(law).document(phase.law)
        tables.append(table)
    return tables


def motion_document(design: Any) -> list[dict[str, Any]] | dict[str, Any]:
    """Return the motion of a `design` as in a file."""
    document = {"follower": {"motion": design.follower.motion}, "cam": {"form": design.cam.form}}
    return motion_of(design.motion, circumstances(document))


def phases_wanted(motion: Any) -> Iterator[Wanted]:
    """Yield the parts of a `motion` and the classes that they may have (see `Design`)."""
    if not isinstance(motion, Sequence) or isinstance(motion, str):
        yield TITLE, motion, (tuple, *whole_turns())
        return
    for number, phase in enumerate(motion):
        yield f"{TITLE}[{number}]", phase, tuple(PHASES.values())
        if isinstance(phase, RisePhase) and not name_of(MOTION_LAWS, phase.law):
            yield f"{TITLE}[{number}].law", phase.law, tuple(classes_in(MOTION_LAWS).values())


def words() -> dict[str, Collection[str]]:
    """Return the types of phases and the laws, by the keys that choose them."""
    return {f"{TITLE}.type": PHASES.keys(), f"{TITLE}.law": MOTION_LAWS.keys()}


def homes() -> dict[str, str]:
    """Return in words where the keys of a motion belong."""
    by_phase: dict[str, list[str]] = {"law": list(WITH_LAW)}
    for name in PHASES:
        for key in phase_table(name).entries:
            by_phase.setdefault(key, []).append(name)
    by_law: dict[str, list[str]] = {}
    for law in MOTION_LAWS:
        for key in rise_table(law).entries:
            by_law.setdefault(key, []).append(law)
    found = {key: f"with law = {quoted(laws)}" for key, laws in by_law.items()}
    found |= {key: f"of type {quoted(names)}" for key, names in by_phase.items()}
    homes = {key: f"this key belongs under [[{TITLE}]] {words}" for key, words in found.items()}
    turns = (key for known in turn_tables() for key in known.entries)
    return dict.fromkeys(turns, f"this key belongs under [{TITLE}]") | homes


_DESCRIBED: Final = "gearcam.kinds.cam.describe"

MOTION: Final = Main(
    title=TITLE,
    examine=examine_motion,
    document=motion_document,
    table=deferred(f"{_DESCRIBED}:known"),
    homes=homes,
    schema=deferred(f"{_DESCRIBED}:schema"),
    template=deferred(f"{_DESCRIBED}:lines"),
    laws=deferred(f"{_DESCRIBED}:laws"),
    words=words,
)
