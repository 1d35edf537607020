"""Frames and driver angles from tables of tracks are those of the closed form.

Places are random, over several turns, in every cell of the table, and on both sides of the law's
knots. A table that is not exact enough is seen by its own measure.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcam.gears.rolling import Rolling
from gearcam.gears.track_table import LazyTable, TabledCentrode, make_table, missed, tabled
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula
from gearcam.numeric.arrays import Array
from helpers_pairs import job, profile

NAMES = [
    "bspline", "circular", "ellipse", "extreme/concave_just_fits", "extreme/ellipse_95",
    "extreme/ratio_1_to_40", "extreme/ring_tips_pass", "formula", "lobed", "measured",
    "nail_machine_three_phase", "nail_machine_two_phase", "nautilus", "ring_ellipse",
    "ring_uneven", "rounded_square", "two_speeds",
]  # fmt: skip
"""Profiles that have tables: of one lobe and several, wheels and rings, with knots and without."""

SHARP: dict[str, Any] = {
    "a swing of 0.6": Formula(phi2="phi1 - 0.6*sin(phi1)"),
    "an ellipse of 0.97": Ellipse(eccentricity=0.97),
    "steps": Formula(ratio="1 + 0.3*tanh(30*sin(phi1))"),
    "a bump of half a degree": Formula(ratio="1 + 0.001*exp(-20000*sin((phi1 - 1.8)/2)**2)"),
    "a bump of 0.06 degrees": Formula(ratio="1 + 1e-5*exp(-2e6*sin((phi1 - 1.8)/2)**2)"),
    "60 ripples": Formula(ratio="1 + 0.01*sin(60*phi1)"),
}

EACH = 5
"""Random places in each cell."""


def rolling_of(name: str) -> Rolling:
    if name in SHARP:
        return job(SHARP[name], (300, 300), distance=300.0).pair.rolling
    return profile(name).pair.rolling


def places(rolling: Rolling, periods: int) -> Array:
    """Driver angles in all cells and beside knots, each in some lobe of three turns."""
    random = np.random.default_rng(7)
    knots = rolling.law.knots
    ends = rolling.cells(knots)
    inside = ends[:-1] + random.uniform(size=(EACH, len(ends) - 1)) * np.diff(ends)
    beside = [np.nextafter(knots, side) for side in (-np.inf, np.inf)]
    x = np.concatenate([inside.ravel(), knots, *beside, knots - 1e-9, knots + 1e-9])
    return x + rolling.arc.period * random.integers(-periods, 2 * periods, x.size)


@pytest.mark.parametrize("name", [*NAMES, *SHARP])
def test_frames_are_those_of_the_closed_form(name: str) -> None:
    rolling = rolling_of(name)
    size = max(1.0, rolling.center_distance / 100.0)
    for exact, own in zip(rolling.tracks, tabled(rolling), strict=True):
        phi = places(rolling, exact.periods)
        here, found = exact.frames(phi), own.frames(phi)
        assert np.abs(found.p - here.p).max() < 1e-11 * size
        assert np.abs(found.s - here.s).max() < 1e-11 * size
        assert np.abs(found.t - here.t).max() < 1e-11
        assert np.abs(found.speed / here.speed - 1.0).max() < 1e-11
        assert np.abs(found.kappa - here.kappa).max() < 3e-9 * np.abs(here.kappa).max()
        assert np.abs((own.angle(here.s) - phi) * here.speed).max() < 3e-11 * size
        flat = own.frames(phi.reshape(1, -1), curved=False)
        assert flat.kappa.size == 0
        assert flat.p.shape == flat.s.shape == (1, phi.size)
        assert np.array_equal(flat.t[0], found.t)


@pytest.mark.parametrize("name", NAMES)
def test_ordinary_pairs_have_a_table(name: str) -> None:
    rolling = rolling_of(name)
    table = LazyTable(rolling=rolling).table
    assert table is not None
    assert np.isin(rolling.law.knots, table.cells.ends).all()
    assert not missed(rolling, table).any()


def test_where_no_table_is_exact_the_closed_form_answers() -> None:
    rolling = rolling_of("a bump of 0.06 degrees")
    exact, own = rolling.tracks[1], tabled(rolling)[1]
    assert isinstance(own, TabledCentrode)
    assert own.source.table is None
    phi = places(rolling, 1)
    assert np.array_equal(own.frames(phi).p, exact.frames(phi).p)
    assert np.array_equal(own.angle(exact.arc_length(phi)), exact.angle(exact.arc_length(phi)))


def test_a_table_with_a_knot_within_a_cell_is_seen_to_miss() -> None:
    rolling = rolling_of("nail_machine_two_phase")
    ends = LazyTable(rolling=rolling).rolling.cells(rolling.law.knots)
    knot = rolling.law.knots[1]
    table = make_table(rolling, ends[ends != knot])
    wrong = np.flatnonzero(missed(rolling, table))
    at = int(np.searchsorted(table.cells.ends, knot)) - 1
    assert at in wrong


def test_a_table_of_too_wide_cells_is_seen_to_miss() -> None:
    rolling = rolling_of("ellipse")
    assert missed(rolling, make_table(rolling, np.linspace(0.0, rolling.arc.period, 33))).any()


@pytest.mark.parametrize("name", ["furnace_door", "log_spiral"])
def test_open_pairs_have_no_table(name: str) -> None:
    rolling = rolling_of(name)
    assert tabled(rolling) is rolling.tracks
