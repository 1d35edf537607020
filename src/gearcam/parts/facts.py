"""Facts of finished parts, as the results of all types of design show them.

Depends on facts and parts.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from gearcam.base.facts import Fact
from gearcam.base.numerals import formatted

if TYPE_CHECKING:
    from gearcam.parts.body import Part
    from gearcam.parts.tools import ToolLimits


def size_fact(extents: Sequence[float], name: str) -> Fact:
    """Return the overall size of a part as a fact.

    Parameters
    ----------
    extents : sequence of 3 floats, mm
        Along x, y and z of the part's own frame.
    name : str
        Name of the part in messages, such as ``wheel 1``; empty for a single part.

    Returns
    -------
    Fact
        Shown to hundredths of a millimetre.
    """
    meaning = f"overall size of {name}" if name else "overall size"
    text = " x ".join(formatted(round(one, 2), 9) for one in extents)
    return Fact([float(one) for one in extents], meaning, text=text, shown=True)


def part_facts(part: Part, name: str, tools: ToolLimits, density: float | None) -> dict[str, Any]:
    """Return the facts of a part.

    Parameters
    ----------
    part : Part
        The finished part.
    name : str
        Its name in messages (see `size_fact`).
    tools : ToolLimits
        The largest tools for it.
    density : float or None, kg/m^3
        With a density the mass properties are included.

    Returns
    -------
    dict
        Facts that exist.
    """
    from gearcam.parts.mass import mass_properties

    made: dict[str, Any] = {
        "size_mm": size_fact(part.size, name),
        "tool": tools.as_dict(),
        "openings": [opening.as_dict() for opening in part.openings],
    }
    if density is not None:
        made["density_kg_m3"] = density
        mass = mass_properties(part, density).as_dict()
        about = () if part.turns else ("unbalance_g_mm", "unbalance_direction_deg")
        made["mass"] = {name: value for name, value in mass.items() if name not in about}
    return {name: value for name, value in made.items() if value}
