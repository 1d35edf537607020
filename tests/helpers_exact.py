"""Pairs of every law with the law in 30 digits: those of its claims."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from claims.claim import ExactCase, LawClaims
from claims.laws import LAW_CLAIMS
from witness import exact
from witness.exact import Exact, mp, turn_of, whole


def cases() -> dict[str, ExactCase]:
    """Return all pairs by their names: the law and a number."""
    found = {}
    for name, claims in LAW_CLAIMS.items():
        found |= {f"{name}-{number}": case for number, case in enumerate(claims.cases())}
        found |= {f"{name}-claim-{number}": case for number, case in enumerate(_claimed(claims))}
    return found


def _claimed(claims: LawClaims) -> Iterator[ExactCase]:
    """Yield the examples of a law whose claims have its ratio in closed form, if it is closed."""
    if claims.ratio is None:
        return
    for claim in claims.values:
        lobes, law = claim.lobes, _in_30_digits(claim.parameters)
        each = math.ceil(40 / min(lobes.n1, lobes.n2))

        def ratio(x: Any, law: Any = law, lobes: Any = lobes) -> Any:
            return claims.ratio and claims.ratio(law, lobes, x, exact)

        whole_law = Exact(whole(ratio, turn_of(lobes.n1)), lobes.mate)
        teeth = each * lobes.n1, each * lobes.n2
        yield ExactCase(claim.parameters, teeth, lambda _, law=whole_law: law, lobes.mate)


def _in_30_digits(parameters: Any) -> Any:
    """Return parameters whose floats are exact numbers of 30 digits."""

    def exactly(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(exactly, value))
        return mp.mpf(value) if isinstance(value, float) else value

    return replace(parameters, **{key: exactly(value) for key, value in vars(parameters).items()})
