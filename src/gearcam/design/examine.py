"""Examining a design: everything that can be known to be wrong by reading, found in one go.

A *document* is what a design file holds, as nested dictionaries; a design made in Python is turned
into one, so that both meet the same rules. What passes comes back as parameter objects, mm and rad.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, TypeGuard

from gearcam.design.locate import Path
from gearcam.design.models import faults_of
from gearcam.design.tables import KIND, TABLES, Table, law_table, table
from gearcam.design.wording import Fault, did_you_mean, key_hint, quoted, show
from gearcam.laws.base import LAWS

LATER_KINDS: Final = ("cam",)
"""Kinds of design that are planned."""

_NAME = re.compile(r"\w[\w.-]*")
_NAME_RULE: Final = (
    "letters, digits, _ - and . (it names a folder), beginning with a letter or digit"
)
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_LONGEST_NAME: Final = 100
_COARSEST: Final = 50
"""A chord tolerance coarser than module/50 no longer draws a tooth."""

_TOP: Final = ("kind", "name", "law", *TABLES, "limits")
_REQUIRED_TABLES: Final = ("law", "pair")


@dataclass
class Examined:
    """What an examination has found.

    Parameters
    ----------
    faults : list of Fault
        All that is wrong.
    parts : dict
        Parameter objects of what is right, by the names of a design's fields.
    """

    faults: list[Fault] = field(default_factory=list)
    parts: dict[str, Any] = field(default_factory=dict)


def examine(document: Mapping[str, Any], *, stem: str = "") -> Examined:
    """Examine a document.

    Parameters
    ----------
    document : mapping
        As read from TOML.
    stem : str
        The file's name without its ending: the design's name where the file gives none.

    Returns
    -------
    Examined
        With ``name``, ``law_type``, ``law``, ``pair``, ``rack``, ``blank``, ``limits``, ``output``,
        ``meshing`` where there is no fault.
    """
    found = Examined()
    found.faults += _kind_faults(document)
    if document.get("kind") in LATER_KINDS:
        return found
    found.faults += _top_faults(document)
    _examine_name(document, stem, found)
    _examine_law(document, found)
    for title in TABLES:
        if title not in document and title in _REQUIRED_TABLES:
            continue
        if _clean(table(title), document.get(title, {}), found):
            raw = document.get(title, {})
            made = TABLES[title](**table(title).inward(raw))
            found.faults += _own_problems(made, table(title), raw)
            found.parts[title] = made
    _examine_limits(document, found)
    found.faults += _pair_faults(document.get("pair"))
    found.faults += _output_faults(document.get("output"), document.get("pair"))
    found.faults += _meshing_faults(document.get("meshing"), document.get("pair"))
    found.faults += _step_faults(document.get("meshing"), document.get("helix"))
    return found


def _clean(known: Table, raw: Any, found: Examined) -> bool:
    faults = list(faults_of(known, raw, home=_home))
    found.faults += faults
    return not faults


def _home(key: str) -> str:
    """Return where a key that its table does not know belongs, if any other place has it."""
    homes: dict[str, str] = {}
    for name in TABLES:  # of two tables the first is the likelier
        for known in table(name).entries:
            homes.setdefault(known, f"this key belongs under [{name}]")
    homes |= {"type": "this key belongs under [law]"}
    homes |= dict.fromkeys(("kind", "name"), "this key belongs above all tables")
    laws: dict[str, list[str]] = {}
    for law_type in LAWS:
        for known in law_table(law_type).entries:
            laws.setdefault(known, []).append(f'"{law_type}"')
    for known, types in laws.items():
        homes.setdefault(known, f"this key belongs under [law] of type {' or '.join(types)}")
    return homes.get(key, "")


def _near_home(key: str) -> str:
    for name in TABLES:
        hint = key_hint(key, table(name).entries)
        if hint:
            return f"{hint} (under [{name}])"
    return ""


def _kind_faults(document: Mapping[str, Any]) -> Iterator[Fault]:
    if "kind" not in document:
        yield Fault(("kind",), "is missing", allowed=f'"{KIND}"')
    elif document["kind"] in LATER_KINDS:
        message = f"{show(document['kind'])}: cams are not built by this version yet"
        yield Fault(("kind",), message, document["kind"], f'"{KIND}"')
    elif document["kind"] != KIND:
        kind = document["kind"]
        hint = did_you_mean(kind, [KIND, *LATER_KINDS])
        yield Fault(("kind",), f"{show(kind)} is not a kind of design", kind, f'"{KIND}"', hint)


def _top_faults(document: Mapping[str, Any]) -> Iterator[Fault]:
    for key, value in document.items():
        if key not in _TOP:
            what = "table" if isinstance(value, Mapping) else "key"
            shown = "" if what == "table" else f" (its value is {show(value)})"
            hint = _home(key) or key_hint(key, _TOP) or _near_home(key)
            yield Fault((key,), f"unknown {what}{shown}", value, ", ".join(_TOP), hint)
    for title in _REQUIRED_TABLES:
        if title not in document:
            keys = f"type = {_law_names()}" if title == "law" else ", ".join(table(title).entries)
            yield Fault((title,), f"the table [{title}] is missing", allowed=keys)


def _examine_name(document: Mapping[str, Any], stem: str, found: Examined) -> None:
    name = document.get("name", stem)
    fault = name_fault(name)
    if not fault:
        found.parts["name"] = name
    elif "name" in document:
        found.faults.append(Fault(("name",), f"{show(name)} {fault}", name, _NAME_RULE))
    else:
        message = (
            "is missing" if not stem else f"is missing, and the file's own {show(stem)} {fault}"
        )
        hint = re.sub(r"[^\w-]+", "_", stem).strip("_-")
        hint = f'add name = "{hint}"' if hint else ""
        found.faults.append(Fault(("name",), message, allowed=_NAME_RULE, hint=hint))


def name_fault(name: Any) -> str:
    """Return what keeps a design's name from naming a folder, or nothing."""
    if not isinstance(name, str):
        return "is not text"
    if len(name) > _LONGEST_NAME:
        return f"has {len(name)} characters, and {_LONGEST_NAME} are allowed"
    if not _NAME.fullmatch(name) or name.endswith("."):
        return "cannot name a folder"
    return "is reserved on some systems" if _RESERVED.fullmatch(name) else ""


def _law_names() -> str:
    return quoted(LAWS)


def _examine_law(document: Mapping[str, Any], found: Examined) -> None:
    raw = document.get("law")
    if not isinstance(raw, Mapping):
        if raw is not None:
            rule = f"a table [law] with type = {_law_names()}"
            found.faults.append(Fault(("law",), f"{show(raw)} is not a table", raw, rule))
        return
    law_type = raw.get("type")
    if "type" not in raw:
        found.faults.append(Fault(("law", "type"), "is missing", allowed=_law_names()))
        return
    if not isinstance(law_type, str) or law_type not in LAWS:
        message = f"{show(law_type)} is not a law"
        hint = did_you_mean(law_type, LAWS)
        found.faults.append(Fault(("law", "type"), message, law_type, _law_names(), hint))
        return
    known = law_table(law_type)
    rest = {key: value for key, value in raw.items() if key != "type"}
    faults = list(faults_of(known, rest, home=_home))
    found.faults += faults
    # What a law itself finds is said beside the faults of single values, as far as it can be read.
    if any(len(fault.path) == 2 and fault.path[1] in known.entries for fault in faults):
        return
    wrong = {fault.path[1] for fault in faults}
    readable = {key: value for key, value in rest.items() if key in known.entries}
    try:
        law = LAWS[law_type].parameters(**known.inward(readable))
        problems = [p for p in _own_problems(law, known, rest) if p.path[1] not in wrong]
    except (TypeError, ValueError, AttributeError, IndexError, KeyError):
        if not faults:
            raise
        return
    found.faults += problems
    if not faults and not problems:
        found.parts |= {"law_type": law_type, "law": law}


def _own_problems(made: Any, known: Table, raw: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield what parameters themselves find wrong by reading (their optional ``problems``)."""
    keys = {entry.name: entry.key for entry in known.entries.values()}
    tell: Iterable[tuple[str, int | None, str, str]] = getattr(made, "problems", tuple)()
    seen: set[Path] = set()
    for name, index, message, rule in tell:
        key = keys[name]
        value, path = raw.get(key), (known.title, key)
        if index is not None and (isinstance(value, list) or not known.entries[key].param.both):
            path = (known.title, key, index)
            if isinstance(value, list) and index < len(value):
                value = value[index]
        if path not in seen:  # one value for both wheels is wrong once
            seen.add(path)
            shown = f"{show(value)}: {message}" if value is not None else message
            yield Fault(path, shown, value, rule)


def _examine_limits(document: Mapping[str, Any], found: Examined) -> None:
    if "limits" not in document:
        found.parts["limits"] = {}
    elif _clean(table("limits"), document["limits"], found):
        found.parts["limits"] = table("limits").inward(document["limits"])


def _pair_faults(raw: Any) -> Iterator[Fault]:
    if not isinstance(raw, Mapping):
        return
    rule = "exactly one of center_distance_mm and module_mm; the other is solved"
    distance, module = raw.get("center_distance_mm"), raw.get("module_mm")
    if distance is not None and module is not None:
        message = (
            f"center_distance_mm = {show(distance)} and module_mm = {show(module)} are both given"
        )
        yield Fault(("pair", "module_mm"), message, module, rule)
    elif distance is None and module is None:
        yield Fault(("pair",), "neither center_distance_mm nor module_mm is given", allowed=rule)


def _output_faults(raw: Any, pair: Any) -> Iterator[Fault]:
    if not isinstance(raw, Mapping):
        return
    if raw.get("dxf_curves") == "splines" and raw.get("dxf_version") == "R12":
        rule = '"arcs" or "lines" in R12, "splines" in R2010'
        yield Fault(("output", "dxf_version"), '"R12": it knows no splines', "R12", rule)
    files = raw.get("files")
    if isinstance(files, list):
        for index, name in enumerate(files):
            if isinstance(name, str) and name in files[:index]:
                message = f"{show(name)} is listed twice"
                yield Fault(("output", "files", index), message, name, "each kind of file once")
    module = pair.get("module_mm") if isinstance(pair, Mapping) else None
    tolerance = raw.get("chord_tolerance_mm")
    if _is_number(module) and _is_number(tolerance):
        coarsest = module / _COARSEST
        if tolerance > coarsest > 0:
            message = f"{show(tolerance)} is too coarse for a module of {show(module)} mm"
            rule = f"at most module/{_COARSEST} = {coarsest:g} mm"
            yield Fault(("output", "chord_tolerance_mm"), message, tolerance, rule)


def _meshing_faults(raw: Any, pair: Any) -> Iterator[Fault]:
    if not isinstance(raw, Mapping):
        return
    start, end = raw.get("from_deg", 0), raw.get("to_deg", 360)
    if _is_number(start) and _is_number(end) and not end > start:
        key = "to_deg" if "to_deg" in raw else "from_deg"
        message = f"{show(raw[key])}: the study ends at {show(end)} deg before it begins"
        yield Fault(("meshing", key), message, raw[key], "to_deg above from_deg")
    if raw.get("advance_deg") == 0:
        message = "0: without an advance no flanks overlap, and nothing can be seen"
        yield Fault(("meshing", "advance_deg"), message, 0, "-1 to 1, but not 0; 0.005 is usual")
    given = raw.get("teeth")
    teeth = given if isinstance(given, list) else []
    counts = pair.get("teeth") if isinstance(pair, Mapping) else None
    known = counts[0] if isinstance(counts, list) and counts else None
    for index, tooth in enumerate(teeth):
        path = ("meshing", "teeth", index)
        if _is_number(known) and _is_number(tooth) and tooth > known:
            message = f"the driver has no tooth {show(tooth)}"
            yield Fault(path, message, tooth, f"1 to {show(known)}")
        if tooth in teeth[:index]:
            yield Fault(path, f"{show(tooth)} is listed twice", tooth, "each tooth once")


def _step_faults(meshing: Any, helix: Any) -> Iterator[Fault]:
    step = meshing.get("helix_step", 1) if isinstance(meshing, Mapping) else 1
    steps = helix.get("steps", 1) if isinstance(helix, Mapping) else 1
    if _is_number(step) and _is_number(steps) and step > steps:
        message = f"the wheels have no step {show(step)}"
        yield Fault(("meshing", "helix_step"), message, step, f"1 to {show(steps)} (helix.steps)")


def _is_number(value: Any) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)
