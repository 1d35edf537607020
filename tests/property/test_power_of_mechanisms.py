"""Random loaded mechanisms: the driver's moment against the power balance of positions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import GearcamError
from gearcam.kinds.mechanism.loaded import work_of
from helpers_sampling import few
from random_designs import mechanism
from random_designs.draw import Draw
from witness.power_balance import PowerBalance

_OFF = 2e-5
"""Difference, as a share of the largest moment or of its change nearby, that is an error."""

_ROUNDED = 1e-8
"""The same of moments that are found in two ways from the same motion."""

_NONE = 1e-3
"""Moment, N mm, below which differences are those of rounding."""


def loaded(seed: int) -> Any:
    """A random mechanism with loads that can be built, or None."""
    tables = mechanism.design(Draw(f"power {seed}"), seed)
    if not (tables.get("load") or tables.get("mass") or tables.get("spring")):
        return None
    tables.pop("limits", None)
    try:
        made = gc.build(gc.design({"kind": "mechanism", "name": "drawn", **tables}))
        return made, work_of(made.design, made.linkage, made.drives)
    except GearcamError:
        return None


def off(result: Any, work: Any) -> float:
    """The largest difference of the moments at places away from knots, over their size."""
    balance = PowerBalance(result)
    knots = work.knots
    middles = 0.5 * (knots[1:] + knots[:-1])
    wide = np.diff(knots) > 8.0 * balance.reach
    places = middles[wide][:: max(1, int(wide.sum()) // 6)]
    if not places.size:
        return 0.0
    found = np.asarray(work.moment(places).c[0]) + 0.0 * places
    wanted = np.array([balance.moment(float(q)) for q in places])
    terms = sum(size for _, size in work.works.values()) / np.ptp(knots)
    return float(np.abs(found - wanted).max() / max(np.abs(found).max(), terms, _NONE))


def apart(result: Any, work: Any) -> float:
    """The difference of the moment from the shares of all shafts and slides, over its size."""
    low, high = work.linkage.span
    q = low + (high - low) * (np.arange(9.0) + 0.31) / 9.0
    total = np.zeros(q.shape)
    for drive in result.drives:
        own = drive.spec
        for word in drive.moved:
            names = [f"{own.name}.{word}", *([own.name] if own.even or own.slide else [])]
            rate = work.linkage.track(names[0], q, 1).derivatives()[1]
            total += work.on(dict.fromkeys(names, 1.0), q) * rate
    moment = work.moment(q).derivatives()[0]
    return float(np.abs(total - moment).max() / max(np.abs(moment).max(), _NONE))


@pytest.mark.parametrize("block", few(range(8), 4))
def test_power_balance(block: int) -> None:
    compared = 0
    for seed in range(20 * block, 20 * block + 20):
        made = loaded(seed)
        if made is not None:
            compared += 1
            assert off(*made) < _OFF, seed
            assert apart(*made) < _ROUNDED, seed
    assert compared > 1
