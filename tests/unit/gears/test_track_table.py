"""Tables of centrodes against their closed form."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcam.gears.track_table import Cells, LazyTable, TabledCentrode, make_table, missed
from helpers_built import built
from helpers_sampling import few

NAMES = [
    "ellipse", "nail_machine_two_phase", "nail_machine_three_phase", "circular", "log_spiral",
    "two_lobed_ellipse", "ring_ellipse", "rounded_square", "measured", "harmonics", "limacon",
    "bspline", "formula",
]  # fmt: skip

FAR = 1e-10
"""Distance of points, and difference of arc lengths, mm."""


def pair(name: str, changes: dict[str, Any] | None = None) -> Any:
    design = built(f"profiles/{name}.toml").design
    return built(design.with_(changes) if changes else design).pair


def tracks(made: Any) -> list[Any]:
    return [toothing.track for toothing in made.toothings]


@pytest.mark.parametrize("name", few(NAMES, 2))
def test_a_table_has_the_frames_of_the_closed_form(name: str) -> None:
    made = pair(name)
    if not made.law.closed:
        pytest.skip("open pairs have no table")
    period, knots = made.law.period, np.asarray(made.law.knots)
    rng = np.random.default_rng(1)
    beside = np.concatenate([knots[1:-1] - 1e-9, knots[1:-1], knots[1:-1] + 1e-9])
    phi = np.concatenate([rng.uniform(-period, 3.0 * period, 3000), beside])
    for track, exact in zip(tracks(made), made.rolling.tracks, strict=True):
        assert isinstance(track, TabledCentrode)
        assert track.source.table is not None
        own, wanted = track.frames(phi), exact.frames(phi)
        assert np.abs(own.p - wanted.p).max() < FAR
        assert np.abs(own.s - wanted.s).max() < FAR
        assert np.abs(own.t - wanted.t).max() < 1e-10
        assert own.speed == pytest.approx(wanted.speed, rel=1e-10)
        assert np.abs(own.kappa - wanted.kappa).max() < 1e-8 * np.abs(wanted.kappa).max()
        assert np.abs(track.angle(wanted.s) - phi).max() < 1e-11


def test_a_table_that_misses_the_closed_form_is_noticed() -> None:
    rolling = pair("nail_machine_two_phase").rolling
    cells = np.asarray(rolling.cells(rolling.law.knots))
    table = make_table(rolling, cells)
    assert not missed(rolling, table).any()
    wheels = tuple(one.copy() for one in table.wheels)
    wheels[1][7, 0, 5] += 1e-8  # the highest power of x in one cell
    assert np.flatnonzero(missed(rolling, table._replace(wheels=wheels))).tolist() == [5]
    coarse = make_table(rolling, cells[:: len(cells) // 8])
    assert missed(rolling, coarse).any()


def test_cells_that_bridge_a_knot_are_noticed() -> None:
    """The acceleration of the law of two phases jumps there."""
    rolling = pair("nail_machine_two_phase").rolling
    cells, knots = np.asarray(rolling.cells(rolling.law.knots)), np.asarray(rolling.law.knots)
    inner = knots[1:-1]
    away = cells[~np.isclose(cells[:, None], inner, rtol=0.0, atol=1e-12).any(axis=1)]
    assert len(away) < len(cells)
    assert missed(rolling, make_table(rolling, away)).any()


def test_without_an_accurate_table_the_closed_form_answers(monkeypatch: Any) -> None:
    made = pair("ellipse")
    monkeypatch.setattr("gearcam.gears.track_table._MOST", 3)
    source = LazyTable(rolling=made.rolling)
    assert source.table is None
    phi = np.linspace(0.0, 7.0, 50)
    for track, exact in zip(tracks(made), made.rolling.tracks, strict=True):
        own = replace(track, source=source)
        assert own.frames(phi).p.tolist() == exact.frames(phi).p.tolist()
        s = exact.frames(phi).s
        assert own.angle(s).tolist() == exact.angle(s).tolist()


def test_racks_and_open_pairs_have_none() -> None:
    for name in ("log_spiral", "feeder"):
        assert not any(isinstance(track, TabledCentrode) for track in tracks(pair(name)))


def test_places_belong_to_the_cell_after_an_end() -> None:
    cells = Cells.between(np.array([0.0, 1.0, 3.0]))
    number, share = cells.holding(np.array([0.0, 1.0, 2.0, 3.0]))
    assert number.tolist() == [0, 1, 1, 1]
    assert share.tolist() == [0.0, 0.0, 0.5, 1.0]
