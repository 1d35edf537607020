"""Random ratio laws, one generator for all: random designs, claims and property tests use it.

By default the parameters follow from their ranges and the law's example, and the tooth counts from
what the law can close. The claims of a law (`claims.laws`) may narrow the ranges (`usual`) or draw
the law themselves (`draw`).
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, Final

from claims.claim import LawClaims
from claims.laws import LAW_CLAIMS
from gearcam.base.errors import InfeasibleError
from gearcam.base.quantities import REQUIRED, Param, params_of
from gearcam.base.tolerances import DEFAULT
from gearcam.kinds.gear_pair.design import law_table
from gearcam.laws.ratio.base import LAWS
from gearcam.laws.ratio.span import Lobes
from random_designs.draw import short
from random_designs.law_draw import LOBES, Counts, Law, LawDraw

_TEETH: Final = 8
"""Fewest teeth of a law that does not draw its own."""

_NEAR: Final = 1e-3
"""Smallest share of a range that begins at 0: small swings have their own numerical errors."""

_NO_CLAIMS: Final = LawClaims(values=())


def random_law(d: LawDraw, name: str) -> tuple[Law, Counts]:
    """Return the table of a random law of this `name`, and tooth counts that it can close."""
    claims = LAW_CLAIMS.get(name, _NO_CLAIMS)
    law, z = claims.draw(d) if claims.draw else _by_ranges(d, name, claims.usual)
    return {"type": name, **law}, z


def parameters(law: Mapping[str, Any]) -> Any:
    """Return the parameters of a law for its table."""
    entry = LAWS[law["type"]]
    given = {key: value for key, value in law.items() if key != "type"}
    return entry.parameters(**law_table(entry.name).inward(given))


def _by_ranges(
    d: LawDraw, name: str, usual: Mapping[str, tuple[float, float]]
) -> tuple[Law, Counts]:
    example, table = LAWS[name].example, law_table(name)
    shown = table.outward(vars(example))
    law: Law = {}
    for field, param in params_of(type(example)).items():
        key = param.key(field)
        if field in usual or _required(type(example), field) or param.choices:
            law[key] = _value(d, param, shown.get(key), usual.get(field))
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


def _required(owner: Any, field: str) -> bool:
    (found,) = (one for one in dataclasses.fields(owner) if one.name == field)
    return found.default is REQUIRED


def _value(d: LawDraw, param: Param, shown: Any, usual: tuple[float, float] | None) -> Any:
    """Return a value in the unit of files: of the usual range, or from a bound to the example."""
    if param.choices:
        return d.pick(param.choices)
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
