"""What goes together in the tables of loads on a follower."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from gearcam.designs.faults import Fault, show
from gearcam.designs.table import table_of
from gearcam.designs.validate import placed_faults

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined


def load_faults(
    found: Examined, document: Mapping[str, Any], *, oscillating: bool
) -> Iterator[Fault]:
    """Yield loads, springs and masses that do not suit how a follower moves.

    Parameters
    ----------
    found : Examined
        The valid tables.
    document : mapping
        All tables as in the file.
    oscillating : bool
        Whether it swings, or turns.
    """
    for title in ("load", "spring", "mass"):
        for number, one in enumerate(found.parts.get(title, ())):
            breaches = one.allowed_on(oscillating=oscillating)
            raw = document[title][number]
            yield from placed_faults(breaches, table_of(title, type(one)), raw, (title, number))
    solved = [one.solved for one in found.parts.get("spring", ())]
    if sum(solved) > 1:
        second = [number for number, one in enumerate(solved) if one][1]
        message = 'a second spring is solved too: "solve" stands in one of them'
        yield Fault(("spring", second), message, allowed="numbers in all springs but one")
    yield from _weightless(found, document)


def _weightless(found: Examined, document: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield the fault of gravity where there is no mass on which it acts."""
    gravity, masses = document.get("gravity"), found.parts.get("mass", ())
    heavy = any(one.mass is not None for one in masses) or (document.get("mass") and not masses)
    if isinstance(gravity, Mapping) and "direction_deg" in gravity and not heavy:
        value = gravity["direction_deg"]
        message = f"{show(value)}: the follower has no mass on which gravity acts"
        allowed = "with a table [[mass]] that has mass_kg"
        yield Fault(("gravity", "direction_deg"), message, value, allowed)
