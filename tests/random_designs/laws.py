"""Random ratio laws and motion laws, one generator for all: random designs, claims, property tests.

By default the parameters follow from their ranges and the law's example, and the tooth counts from
what the law can close. The claims of a law (`claims.laws`, `claims.motion`) may narrow the ranges
(`usual`) or draw the law themselves (`draw`).
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, Final

from claims.claim import LawClaims, MotionClaims
from claims.laws import LAW_CLAIMS
from claims.motion import MOTION_CLAIMS
from gearcam.base.errors import InfeasibleError
from gearcam.base.quantities import REQUIRED, Param, params_of
from gearcam.base.tolerances import DEFAULT
from gearcam.designs.table import Table
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS
from gearcam.laws.ratio.span import Lobes
from helpers_tables import law_table, rise_table
from random_designs.draw import Draw, short
from random_designs.law_draw import LOBES, Counts, Law, LawDraw

_TEETH: Final = 8
"""Fewest teeth of a law that does not draw its own."""

_NEAR: Final = 1e-3
"""Smallest share of a range that begins at 0: small swings have their own numerical errors."""

_LEFT_OUT: Final = 0.3
"""How often an optional parameter is left out."""


def random_law(d: LawDraw, name: str) -> tuple[Law, Counts]:
    """Return the table of a random ratio law of this `name`, and tooth counts that it can close."""
    claims = LAW_CLAIMS.get(name, LawClaims(values=()))
    law, z = claims.draw(d) if claims.draw else _with_counts(d, name, claims.usual)
    return {"type": name, **law}, z


def random_motion_law(d: Draw, name: str) -> Law:
    """Return the keys of a random motion law of this `name`, for a phase."""
    claims = MOTION_CLAIMS.get(name, MotionClaims(values=()))
    if claims.draw:
        law = claims.draw(d)
    else:
        law = _by_ranges(d, MOTION_LAWS[name].example, rise_table(name), claims.usual)
    return {"law": name, **law}


def parameters(law: Mapping[str, Any]) -> Any:
    """Return the parameters of a law, or of a motion law, for its keys."""
    given = dict(law)
    if name := given.pop("type", ""):
        return LAWS[name].parameters(**law_table(name).inward(given))
    name = given.pop("law")
    return MOTION_LAWS[name].parameters(**rise_table(name).inward(given))


def _with_counts(
    d: LawDraw, name: str, usual: Mapping[str, tuple[float, float]]
) -> tuple[Law, Counts]:
    table = law_table(name)
    law = _by_ranges(d, LAWS[name].example, table, usual)
    for lobes in sorted(LOBES, key=lambda _: d.random.random()):
        z = d.of_lobes(lobes, _TEETH)
        more = law
        if "lobes" in table.entries and d.chance(0.4):
            parts = [n for n in (1, 2, 3) if math.gcd(*z) // n >= 8 and math.gcd(*z) % n == 0]
            common = math.gcd(*z) // d.pick(parts or [1])
            more = law | {"lobes": [z[0] // common, z[1] // common]}
        if _closes({"type": name, **more}, z):
            return more, z
    return law, d.equal(_TEETH)


def _by_ranges(
    d: Draw, example: Any, table: Table, usual: Mapping[str, tuple[float, float]]
) -> Law:
    """Return the keys of a law: all that are required or have a usual range or choices."""
    shown = table.outward(vars(example))
    law: Law = {}
    for field, param in params_of(type(example)).items():
        required, key = _required(type(example), field), param.key(field)
        if not required and ((field not in usual and not param.choices) or d.chance(_LEFT_OUT)):
            continue
        law[key] = _value(d, param, shown.get(key), usual.get(field))
    return law


def _required(owner: Any, field: str) -> bool:
    (found,) = (one for one in dataclasses.fields(owner) if one.name == field)
    return found.default is REQUIRED


def _value(d: Draw, param: Param, shown: Any, usual: tuple[float, float] | None) -> Any:
    """Return a value in the unit of files: of the usual range, or from a bound to the example."""
    if param.choices:
        return d.pick(tuple(param.choices))
    bounds = [bound for bound in (param.ge, param.gt) if bound is not None]
    if usual is None and (isinstance(shown, bool | str | list) or not bounds):
        return shown
    low, high = usual or (min(bounds[0], shown), shown)
    if isinstance(shown, int):
        return d.whole(int(low), int(high))
    if low == 0.0 < high:
        low = _NEAR * high
    return d.log(low, high) if low > 0.0 and d.chance(0.5) else short(d.even(low, high))


def _closes(law: Law, z: Counts) -> bool:
    """Return whether the law can close for these tooth counts."""
    common = math.gcd(*z)
    try:
        parameters(law).build(Lobes(z[0] // common, z[1] // common), DEFAULT)
    except InfeasibleError:
        return False
    return True
