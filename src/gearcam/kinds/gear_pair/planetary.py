"""Why planetary pairs (planet on a carrier between sun and ring) are not available."""

from __future__ import annotations

import math
from typing import Any, Final

from gearcam.base.numerals import shown
from gearcam.designs.faults import Fault

_RULE: Final = "two tooth counts, driver first; design each pair of wheels separately"


def planet_curve(sun: int, planet: int, ring: int) -> tuple[float, float]:
    """Return the planet curve ``r = A*x*(1 + e*cos(n*phi))`` that meshes with sun and ring.

    Parameters
    ----------
    sun, planet, ring : int
        Lobes or tooth counts; ``ring >= sun + 2*planet``.

    Returns
    -------
    x, e : float
        Mean radius over the centre distance A of both pairs, and amplitude over the mean radius;
        0 for round wheels, 1 or more if there is no such curve.

    Notes
    -----
    Over a turn of the planet the ratio to the sun, ``r/(A - r)``, has the mean planet/sun, that to
    the ring, ``r/(A + r)``, planet/ring. The first is convex in r and the second concave, so that
    both are possible only if ``ring > sun + 2*planet``, or on circles (Jensen). For this curve the
    means are those of ``1/(a + b*cos)``, whence ``(1 - x)^2 - (x*e)^2 = (sun/(sun + planet))^2``
    and ``(1 + x)^2 - (x*e)^2 = (ring/(ring - planet))^2``.
    """
    near, far = (sun / (sun + planet)) ** 2, (ring / (ring - planet)) ** 2
    x = 0.25 * (far - near)
    swing = (1.0 - x) ** 2 - near if ring > sun + 2 * planet else 0.0
    return x, math.sqrt(swing) / x


def planetary_fault(teeth: Any) -> Fault:
    """Return the fault of a design that asks for a planet on a carrier.

    Parameters
    ----------
    teeth : object
        Value of ``pair.teeth``.

    Returns
    -------
    Fault
        With numbers, if the tooth counts of sun, planet and ring are given.
    """
    what = "a planet between sun and ring on a carrier is not available"
    counts = teeth if isinstance(teeth, list) and len(teeth) == 3 else []
    if not counts or any(type(count) is not int or count < 1 for count in counts):
        why = "non-circular wheels need a ring of more than sun + 2*planet teeth"
        return Fault(("pair",), f"{what}: {why}", allowed=_RULE)
    sun, planet, ring = counts
    least = sun + 2 * planet
    if ring < least:
        state = f"a ring needs at least {least} teeth here"
    elif ring == least:
        state = "only round wheels mesh with these teeth"
    else:
        x, e = planet_curve(sun, planet, ring)
        lobes = planet // math.gcd(*counts)
        wave = f"cos({lobes}*phi)" if lobes > 1 else "cos(phi)"
        state = (
            f"at its angle phi its radius would be {shown(x)}*A*(1 + {shown(e)}*{wave}), A being "
            "the centre distance"
        )
        if e >= 1.0:
            state += ", which does not close around a shaft"
    hint = f"with {least} teeth the ring and all wheels are round"
    return Fault(("pair", "teeth"), f"{what}: {state}", teeth, _RULE, hint)
