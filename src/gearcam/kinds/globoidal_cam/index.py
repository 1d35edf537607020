"""The table ``[index]`` of a design: the motion law of the index and the law's parameters."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import partial
from typing import Any, Final

from gearcam.base.registry import name_of
from gearcam.designs.examine import chosen, home_of
from gearcam.designs.faults import MISSING, Fault, quoted, show
from gearcam.designs.kind import KINDS, Examined
from gearcam.designs.table import Table, table_of
from gearcam.designs.validate import faults_of, parameters_of
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.spatial.globoidal_spec import IndexSpec

TITLE: Final = "index"
NAME: Final = "globoidal-cam"
"""Name of the kind, as in a file."""


def law_table(law: str) -> Table:
    """Return the table of a law's parameters."""
    return table_of(TITLE, MOTION_LAWS[law].parameters)


def index_table(law: str) -> Table:
    """Return the table for a law, without the key ``law``."""
    own = table_of(TITLE, IndexSpec)
    return Table(TITLE, None, {**own.entries, **law_table(law).entries})


def examine_index(document: Mapping[str, Any], found: Examined) -> None:
    """Examine the index of a document.

    Parameters
    ----------
    document : mapping
        As read from TOML.
    found : Examined
        Gets the faults, or ``index``.
    """
    raw = document.get(TITLE, MISSING)
    if not isinstance(raw, Mapping):
        lacks = raw is MISSING
        message = f"the table [{TITLE}] is missing" if lacks else f"{show(raw)} is not a table"
        rule = f"[{TITLE}] with angle_deg and law = {quoted(MOTION_LAWS)}"
        found.faults.append(Fault((TITLE,), message, raw, rule))
        return
    law, right = chosen((TITLE,), raw, "law", "a motion law", MOTION_LAWS, found)
    if not law:
        return
    known, own, shape = index_table(law), table_of(TITLE, IndexSpec), law_table(law)
    rest = {key: value for key, value in raw.items() if key != "law"}
    faults = list(
        faults_of(known, rest, home=partial(home_of, KINDS[NAME]), listed=["law", *known.entries])
    )
    if not right:  # what is missing is reported once the law is known
        found.faults += [fault for fault in faults if fault.path[1] in rest]
        return
    parameters, problems = parameters_of(
        shape, MOTION_LAWS[law].parameters, _only(rest, shape), faults, (TITLE,)
    )
    make = partial(IndexSpec, law=parameters)
    made, more = parameters_of(own, make, _only(rest, own), faults, (TITLE,))
    found.faults += [*faults, *problems, *more]
    if made is not None and not (faults or problems or more):
        found.parts[TITLE] = made


def _only(raw: Mapping[str, Any], table: Table) -> dict[str, Any]:
    return {key: value for key, value in raw.items() if key in table.entries}


def index_document(design: Any) -> dict[str, Any]:
    """Return the table of a `design` as in a file."""
    given, law = design.index, name_of(MOTION_LAWS, design.index.law)
    own = table_of(TITLE, IndexSpec).document(given)
    return {"law": law, **own, **law_table(law).document(given.law)}


def known(raw: Mapping[str, Any]) -> Table:
    """Return the table as it is in a file."""
    return index_table(raw["law"])


def words() -> dict[str, Collection[str]]:
    """Return the laws, by the key that chooses them."""
    return {f"{TITLE}.law": MOTION_LAWS.keys()}


def homes() -> dict[str, str]:
    """Return hints by key that say which laws have it."""
    laws: dict[str, list[str]] = {}
    for law in MOTION_LAWS:
        for key in law_table(law).entries:
            laws.setdefault(key, []).append(law)
    found = {
        key: f"this key belongs under [{TITLE}] with law = {quoted(names)}"
        for key, names in laws.items()
    }
    own = ("law", *table_of(TITLE, IndexSpec).entries)
    return found | dict.fromkeys(own, f"this key belongs under [{TITLE}]")
