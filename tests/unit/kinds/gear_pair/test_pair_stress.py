"""The study of stress of a pair: its files, facts, findings, and what it refuses."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError, MissingExtraError
from gearcam.kinds.gear_pair import elastic_pair, stress
from gearcam.stress import influence
from helpers_elastic import remembered
from helpers_remedies import CIRCLE, DOOR, ELLIPSE, pair

ROOTS = ("tension_mpa", "compression_mpa")
LOAD = [{"torque_nm": 40}]


@pytest.fixture(autouse=True)
def _wheels_are_solved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Most pairs here have the same wheels."""
    monkeypatch.setattr(influence, "influence", remembered(influence.influence))


def built(teeth: int = 12, load: Any = LOAD, law: Any = ELLIPSE, **tables: Any) -> Any:
    rack = {"pressure_angle_deg": 25}
    document = pair(law, [teeth, teeth], load=load, rack=rack, **tables)
    return gearcam.build(gearcam.design(document))


@cache
def study() -> Any:
    tables = {"blank": {"bore_diameter_mm": 8}, "material": {"yield_mpa": [400, 800]}}
    return built(**tables).study("stress")


def test_every_phase_has_its_forces_and_roots() -> None:
    table, stiffness = study().columns, study().files["stiffness.csv"].decode().split("\n")
    phases, row = np.unique(table["phi1_deg"], return_inverse=True)
    assert 120 < len(phases) < 140  # extremes are added
    assert len(phases) == len(stiffness) - 2
    assert np.bincount(row, table["share"]) == pytest.approx(1.0)
    assert (np.bincount(row) == table["pairs"][np.unique(row, return_index=True)[1]]).all()
    assert (table["tension1_mpa"] > 0.0).all()
    assert (table["compression2_mpa"] < 0.0).all()
    assert np.isnan(table["pressure_mpa"][table["edge"] == 1.0]).all()
    # the sum of the normal forces has the load's moment about the driven shaft
    result = study().result
    known = result.study("forces").columns
    total = np.bincount(known["phase"].astype(int) - 1, known["normal_n"])
    angle = np.zeros(len(total))
    angle[known["phase"].astype(int) - 1] = known["phi1_deg"]
    own = np.bincount(row, table["force_n"])
    flanks = np.bincount(row, table["edge"]) == 0
    assert own[flanks] == pytest.approx(np.interp(phases, angle, total)[flanks], rel=2e-3)


def test_the_worst_root_of_each_wheel_is_certified() -> None:
    facts = study().facts
    for wheel in (0, 1):
        key = f"stress.gears.{wheel}"
        assert facts[f"{key}.root.error"] < 0.01
        for sort in ("tension_mpa", "compression_mpa"):
            screened, known = facts[f"{key}.screen.{sort}"], facts[f"{key}.root.{sort}"]
            assert known == pytest.approx(screened, rel=0.06)
    ends = [abs(facts[f"stress.gears.0.root.{sort}"]) for sort in ROOTS]
    assert facts["stress.gears.0.root.safety"] == pytest.approx(400.0 / max(ends))
    assert facts["stress.lag_arcsec.max"] > facts["stress.lag_arcsec.min"] > 0.0
    assert study().complete


def test_findings_say_what_fails() -> None:
    found = {one.code: one for one in study().study_findings}
    assert {"root-stress", "contact-pressure", "loaded-edge"} <= {*found}
    root = found["root-stress"]
    assert root.limit == 1.5
    assert root.value is not None
    assert (root.severity == "error") == (root.value < 1.0)


def test_charts_show_roots_lag_and_shares() -> None:
    charts = study().charts
    assert {*charts} == {"roots", "roots_of_teeth", "lag", "stiffness", "shares"}
    for chart in charts.values():
        assert all(np.isfinite(line.y).all() for line in chart.lines)


def test_wheels_are_coloured_by_their_worst_roots() -> None:
    for number, curve in enumerate(study().coloured()):
        (values,) = curve.values.values()
        screen = study().facts
        ends = [screen[f"stress.gears.{number}.screen.{sort}"] for sort in ROOTS]
        assert curve.body == f"gear{number + 1}"
        assert np.nanmax(values) == pytest.approx(max(map(abs, ends)))
        assert len(np.unique(values[np.isfinite(values)])) == 12  # a colour for each tooth


def test_pictures_of_roots_name_the_stresses() -> None:
    pictures = {name: one for name, one in study().files.items() if name.endswith(".svg")}
    assert len(pictures) == 2
    for number, content in enumerate(pictures.values()):
        known = study().facts[f"stress.gears.{number}.root.tension_mpa"]
        assert f"tension {known:.4g} MPa" in content.decode()


@pytest.mark.slow
def test_the_report_has_the_pictures() -> None:
    asked = {"files": ["report"], "studies": ["stress"]}
    page = built(output=asked, stress={"phases": 24}).files("report")["report.html"].decode()
    assert page.count('src="data:image/svg+xml') == 2
    assert "worst root of the tooth over the turn, MPa" in page


def test_teeth_and_a_phase_may_be_asked_for() -> None:
    asked = {"wheel": 2, "teeth": [3, 7], "phases": 24}
    facts = built(stress=asked).study("stress").facts
    assert [facts[f"stress.gears.1.roots.{k}.tooth"] for k in (0, 1)] == [3, 7]
    assert "stress.gears.0.root" not in facts
    phase = built(stress={"phi1_deg": 100, "wheel": 1, "phases": 24}).study("stress").facts
    assert phase["stress.gears.0.root.phi1_deg"] == pytest.approx(100.0)


def test_another_tooth_has_its_own_stress() -> None:
    """Not that of the tooth that carries."""
    asked = {"wheel": 1, "teeth": [1, 7], "phi1_deg": 5, "phases": 24}
    made = built(stress=asked).study("stress")
    assert [one.code for one in made.study_findings].count("unloaded-root") == 1
    near, far = (made.facts[f"stress.gears.0.roots.{k}.tension_mpa"] for k in (0, 1))
    assert near > 5.0 * abs(far)


def test_extremes_lie_between_the_phases() -> None:
    """Few phases find what many do."""
    few, many = (built(stress={"phases": one, "edges": False}) for one in (48, 480))
    pairs = [elastic_pair.ElasticPair(one) for one in (few, many)]
    worst = []
    for pair_of, count in zip(pairs, (48, 480), strict=True):
        even = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False) + np.pi / count
        entries = pair_of.entries(even)
        added = pair_of.entries(stress.extremes(pair_of, even, entries))
        worst.append([one.max() for one in added.worst] + [added.lag.max(), -added.lag.min()])
    assert worst[0] == pytest.approx(worst[1], rel=2e-3)


def test_friction_is_in_the_balance() -> None:
    """With one pair alone each phase: its force is what the study of forces has for it."""
    tables = {"friction": {"flank": 0.2}, "stress": {"alone": True, "phases": 24, "wheel": 1}}
    made = elastic_pair.ElasticPair(built(**tables))
    entries = made.entries(np.array([0.3]))
    forces = made.under.loaded(np.array([0.3])).forces
    gain = forces.teeth.gain[1]
    assert entries.force * made.width == pytest.approx(40_000.0 / gain, rel=1e-9)
    assert entries.load == pytest.approx(40_000.0)
    # the force that stresses the tooth, friction included, has the load's moment
    certificate = made.certified(entries, 2, int(entries.teeth[1, 0]), 0).certificate
    (load,) = certificate.loads
    at, _ = made.regions[1].teeth.at(np.array([load.place]))
    moment = np.imag(np.conj(at) * load.force) * made.width
    assert np.abs(moment) == pytest.approx(40_000.0, rel=1e-6)


def test_a_rack_and_its_wheel() -> None:
    law = {"type": "rack", "r1": "1"}
    document = pair(law, [14, 14], load=[{"force_n": 2000}], stress={"phases": 24, "wheel": 1})
    made = gearcam.build(gearcam.design(document)).study("stress")
    assert 0.0 < made.facts["stress.lag_mm.min"] < made.facts["stress.lag_mm.max"] < 0.1
    assert made.facts["stress.gears.0.root.error"] < 0.01
    sums = np.zeros(len(np.unique(made.columns["phi1_deg"])))
    np.add.at(sums, np.unique(made.columns["phi1_deg"], return_inverse=True)[1],
              made.columns["force_n"])  # fmt: skip
    flat = sums * np.cos(np.radians(20.0))
    assert flat == pytest.approx(2000.0, rel=0.05)  # on an edge the normal is another


def test_the_lag_is_behind_the_nominal_place() -> None:
    """With backlash that of the flanks adds to it; a load that pulls leads instead."""
    free, loose = (
        elastic_pair.ElasticPair(built(pair={"backlash_mm": gap}, stress={"edges": False}))
        for gap in (0.0, 0.1)
    )
    phi1 = np.array([0.4, 1.9])
    one, other = free.entries(phi1), loose.entries(phi1)
    lead = loose.under.loaded(phi1).forces.teeth.points
    first = np.array([lead.lead[lead.step == k][0] for k in range(2)])
    assert other.lag - other.bent == pytest.approx(-first)
    assert other.bent == pytest.approx(one.bent, rel=0.05)
    pulled = elastic_pair.ElasticPair(built(load=[{"torque_nm": -40}])).entries(phi1)
    assert (pulled.lag < 0.0).all()
    assert (pulled.bent > 0.0).all()


def test_soft_teeth_bend_over_wide_gaps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Edges are looked for as far as the teeth bend."""
    soft = {"material": {"name": ["petg"]}, "pair": {"module_mm": 1}}
    document = pair(CIRCLE, [16, 16], load=[{"torque_nm": 1.6}], **soft)
    made = elastic_pair.ElasticPair(gearcam.build(gearcam.design(document)))
    phi1 = np.linspace(0.1, 0.5, 8)
    wide = made.entries(phi1)
    monkeypatch.setattr(elastic_pair, "_FAR", 0.0)
    narrow = made.entries(phi1)
    assert wide.bent.mean() < 0.995 * narrow.bent.mean()


def test_phases_without_contact_are_told() -> None:
    rack, tables = {"addendum": 0.55}, {"stress": {"phases": 40, "wheel": 1, "edges": False}}
    document = pair(CIRCLE, [20, 20], load=[{"torque_nm": 10}], rack=rack, **tables)
    result = gearcam.build(gearcam.design(document))
    apart = [one for one in result.study("forces").study_findings if one.code == "unstated-forces"]
    assert apart
    made = result.study("stress")
    told = [one for one in made.study_findings if one.code == "unstated-stress"]
    assert told or len(np.unique(made.columns["phi1_deg"])) >= 40


def test_an_interrupted_study_keeps_its_phases(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(elastic_pair.ElasticPair, "certified", interrupted)
    made = built(stress={"phases": 24}).study("stress")
    assert not made.complete
    assert len(made.columns["phi1_deg"]) >= 24
    assert "stress.gears.0.root" not in made.facts
    assert made.facts["stress.gears.0.screen.tension_mpa"] > 0.0


@pytest.mark.slow
def test_open_pairs_and_loads_that_pull() -> None:
    """Both flanks carry in turn; the wheel of an open pair is held on its bore."""
    blank = {"bore_diameter_mm": 8, "timing_marks": False}
    loads = [{"formula": "20*cos(3*phi1)"}]
    made = built(20, loads, DOOR, blank=blank, stress={"phases": 30}).study("stress")
    forces = made.columns["force_n"]
    assert (forces > 0.0).all()
    assert made.facts["stress.gears.1.root.error"] < 0.01


@pytest.mark.slow
def test_large_wheels_are_certified_on_a_sector(monkeypatch: pytest.MonkeyPatch) -> None:
    """The rest of the wheel does not matter to the roots."""
    asked = {"phases": 24, "wheel": 1}
    whole = built(24, stress=asked).study("stress").facts
    monkeypatch.setattr(elastic_pair, "_LARGE", 10)
    part = built(24, stress=asked).study("stress").facts
    key = "stress.gears.0.root"
    assert part[f"{key}.unknowns"] < whole[f"{key}.unknowns"]
    for sort in ("tension_mpa", "compression_mpa"):
        assert part[f"{key}.{sort}"] == pytest.approx(whole[f"{key}.{sort}"], rel=0.01)


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "no load": ({"load": []}, "nothing acts on the pair"),
    "stepped": ({"steps": {"count": 2}}, "stress of stepped wheels is not computed"),
    "no such tooth": ({"stress": {"teeth": [13]}}, "the wheel has no such tooth"),
    "the held circle is in the roots": ({"stress": {"held_diameter_mm": 22}}, "held circle"),
    "a force too large": ({"load": [{"torque_nm": 4000}]}, "too large"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused(name: str) -> None:
    tables, words = REFUSED[name]
    with pytest.raises((DesignError, InfeasibleError), match=re.escape(words)):
        built(**{"load": LOAD, **tables}).study("stress")


def test_a_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(MissingExtraError, match=re.escape("gearcam[stress]")):
        built().study("stress")
