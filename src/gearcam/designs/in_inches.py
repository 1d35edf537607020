"""Faults of designs in inches: found in mm, with the keys and the values of the file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from gearcam.base.inches import INCH, key_in, of_pitch, told, unit_in, value_in
from gearcam.base.quantities import Quantity, unit_of
from gearcam.designs.faults import MISSING, Fault, show
from gearcam.designs.measures import measure_hint
from gearcam.designs.table import Key

_VALUE = "\0"
"""Stands for the value in a message while this is translated."""


def as_in_file(fault: Fault, document: Mapping[str, Any]) -> Fault:
    """Return a fault of a document in mm as one of the document that it was made of.

    Parameters
    ----------
    fault : Fault
        Its path, its value and the lengths in its words are in mm.
    document : mapping
        As in the file, in inches.

    Returns
    -------
    Fault
        With path and value of the file, and lengths in inches. One of a nested file is not changed.
    """
    if fault.file:
        return fault
    path, value = _found(fault, document)
    key, message, allowed, hint = str((*path, "")[-2]), fault.message, fault.allowed, fault.hint
    if MISSING in (value, fault.value):
        value = fault.value
    else:
        message = message.replace(show(fault.value), _VALUE, 1)
    unit = unit_of(key)
    wrong = isinstance(value, str) and re.search("is not (a number|one of the allowed)", message)
    measured = wrong and unit.startswith("in") and "did you mean" not in hint  # such as "solve"
    if measured:
        hint = measure_hint(value, unit, key=key, classes="ISO 286" in allowed)
    return replace(
        fault,
        path=path,
        value=value,
        message=told(message, "inch").replace(_VALUE, show(value)),
        allowed=told(of_pitch(allowed) if key == key_in("module_mm") else allowed, "inch"),
        hint=hint.replace(" in in", " in inches") if measured else told(hint, "inch"),
    )


def entry_in(entry: Key, key: str) -> Key:
    """Return the entry of a length in mm as that of a `key` of a file in inches."""
    param, quantity = entry.param, entry.param.quantity
    names = ("ge", "gt", "le", "lt")
    ends = {name: value_in(entry.key, getattr(param, name)) for name in names}
    if key == key_in("module_mm"):
        ends |= {"ge": ends["le"], "le": ends["ge"]}
        unit = Quantity("", 1.0, "1/in")
    else:
        suffix, named = key_in(quantity.suffix), unit_in(quantity.unit)[0]
        unit = Quantity(suffix, INCH * quantity.factor, named, quantity.least / INCH)
    return replace(entry, key=key, param=replace(param, quantity=unit, **ends))


def _found(fault: Fault, document: Mapping[str, Any]) -> tuple[tuple[str | int, ...], Any]:
    """Return the path of a fault in a document in inches, and what stands there, or `MISSING`."""
    place: Any = document
    path: list[str | int] = []
    for step in fault.path:
        has = place if isinstance(place, Mapping) else ()
        own = key_in(step) if isinstance(step, str) else step
        path.append(step if step in has else own)
        try:
            place = place[path[-1]]
        except (LookupError, TypeError):
            place = MISSING
    return tuple(path), place
