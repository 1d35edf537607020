"""Facts: one tree, told by name, in words and as JSON."""

from __future__ import annotations

import math
import pickle
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from gearcam.base.errors import NotFiniteError
from gearcam.base.facts import Fact, Facts, extent
from gearcam.base.findings import Finding
from helpers_built import built
from helpers_pairs import profile

TREE = {
    "pair": {
        "module_mm": Fact(2.0, "module", at_least=1.5, place="wheel 1"),
        "teeth": [20, 40],
        "missing": None,
    },
    "ratio": Fact(extent(0.5, 2.0), "ratio i21", shown=True),
    "contact_ratio": Fact({"least": 1.5, "mean": 1.75}, "least contact ratio", at_most=3.0),
    "lag_mm": Fact(extent(-1e-14, 2e-14), noise=1e-9),
    "gears": [{"area_mm2": 3.0}, {"area_mm2": Fact(4.0, unit="square mm")}],
}
FACTS = Facts(TREE, headline=("pair.module_mm", "pair.teeth"), title="a pair")


def test_json_holds_values_without_words() -> None:
    assert FACTS.document == {
        "pair": {"module_mm": 2.0, "teeth": [20, 40]},
        "ratio": {"min": 0.5, "max": 2.0},
        "contact_ratio": {"least": 1.5, "mean": 1.75},
        "lag_mm": {"min": -1e-14, "max": 2e-14},
        "gears": [{"area_mm2": 3.0}, {"area_mm2": 4.0}],
    }


def test_values_are_found_by_their_names() -> None:
    assert FACTS["pair.teeth"] == [20, 40]
    assert FACTS["gears.1.area_mm2"] == 4.0
    assert list(FACTS)[:3] == ["pair.module_mm", "pair.teeth", "ratio"]
    assert len(FACTS) == 7
    with pytest.raises(KeyError):
        FACTS["pair.missing"]


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("pair.module_mm", ("module", "2 mm", "at least 1.5 mm", "wheel 1")),
        ("pair.teeth", ("teeth", "20 : 40", "", "")),
        ("ratio", ("ratio i21", "0.5 to 2", "", "")),
        ("contact_ratio", ("least contact ratio", "1.5, mean 1.75", "at most 3", "")),
        ("lag_mm", ("lag", "0 mm", "", "")),
        ("gears.0.area_mm2", ("area", "3 mm2", "", "")),
        ("gears.1.area_mm2", ("area", "4 square mm", "", "")),
    ],
)
def test_each_is_told_with_unit_meaning_limit_and_place(name: str, told: tuple[str, ...]) -> None:
    one = FACTS.quantity(name)
    assert (one.meaning, one.text, one.limit, one.place) == told


def test_the_headline_and_what_is_always_shown() -> None:
    assert FACTS.headline == ("a pair", "module 2 mm", "teeth 20 : 40")
    assert [one.name for one in FACTS.shown()] == ["ratio"]


@pytest.mark.parametrize("name", ["nail_machine_two_phase", "feeder", "ellipse", "undercut_cam"])
def test_a_good_design_shows_ten_lines_at_most(name: str) -> None:
    facts = built(f"profiles/{name}.toml").facts
    lines = list(facts.shown())
    assert 5 <= len(lines) <= 10
    assert all(one.meaning and one.text for one in lines)


@pytest.mark.parametrize("name", ["stepped_ellipse", "plate_cam_offset_roller"])
def test_names_say_their_units(name: str) -> None:
    facts = built(f"profiles/{name}.toml").facts
    named = [one for one in facts.quantities() if one.name.endswith(("_mm", "_deg"))]
    words = {one.name for one in named if not one.unit}
    assert words == {one.name for one in named if isinstance(one.value, str)}
    assert all(name.startswith("accuracy.how.") for name in words)


@pytest.mark.parametrize(
    ("name", "meaning", "text"),
    [
        ("velocity_mm_per_rad", "velocity", "2 mm/rad"),
        ("jerk_deg_per_rad3", "jerk", "2 deg/rad3"),
        ("acceleration_mm_per_mm2", "acceleration", "2 mm/mm2"),
        ("curvature_per_mm", "curvature", "2 1/mm"),
        ("acceleration_per_rad", "acceleration", "2 1/rad"),
        ("travel_per_turn_mm", "travel per turn", "2 mm"),
    ],
)
def test_units_of_rates_are_told(name: str, meaning: str, text: str) -> None:
    one = Facts({name: 2.0}, ()).quantity(name)
    assert (one.meaning, one.text) == (meaning, text)


@pytest.mark.parametrize("name", ["pair.none", "pair.module_mm.x", "gears.7.name", "gears.x", ""])
def test_a_name_that_is_none_is_refused_whole(name: str) -> None:
    facts = built("profiles/ellipse.toml").facts
    assert name not in facts
    with pytest.raises(KeyError, match=re.escape(repr(name))):
        facts[name]


def test_names_of_files_are_found_with_their_dots(tmp_path: Path) -> None:
    written = profile("ellipse").write(tmp_path, files=["dxf"])
    errors = written.facts["accuracy.dxf_mm"]
    assert errors.keys() == {"gear1.dxf", "gear2.dxf", "pair.dxf"}
    assert [written.facts[f"accuracy.dxf_mm.{name}"] for name in errors] == [*errors.values()]
    assert all(name in written.facts for name in written.facts)
    assert repr(written).startswith("BuildOutput(")


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(
    ("tree", "name"),
    [
        (lambda x: {"cam": {"lift_mm": x}}, "the fact cam.lift_mm"),
        (lambda x: {"cam": {"lift_mm": Fact(x)}}, "the fact cam.lift_mm"),
        (lambda x: {"ratio": {"min": 1.0, "max": x}}, "the fact ratio.max"),
        (lambda x: {"gears": [{"size_mm": 1.0}, {"size_mm": [1.0, x]}]}, "gears.1.size_mm.1"),
        (lambda x: {"lift_mm": Fact(1.0, at_most=x)}, "the limit of lift_mm"),
    ],
)
def test_a_number_that_is_not_finite_is_refused_by_its_name(
    tree: Callable[[float], Any], name: str, value: float
) -> None:
    assert len(Facts(tree(2.0))) >= 1
    with pytest.raises(NotFiniteError, match=f"{name}.* is not a finite number, but {value}"):
        Facts(tree(value))
    with pytest.raises(NotFiniteError, match=re.escape(name)):
        Facts({"motion": {"unit": "mm"}}).with_groups(tree(value))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_finding_of_no_finite_value_is_refused(value: float) -> None:
    with pytest.raises(NotFiniteError, match=f"the finding undercut.value .* {value}"):
        Finding(code="undercut", severity="warning", message="", value=value)
    error = pickle.loads(pickle.dumps(NotFiniteError("the fact lift_mm", value)))
    assert str(error) == f"the fact lift_mm is not a finite number, but {value}"


def test_an_extent_is_both_ends_in_another_unit() -> None:
    assert extent(0.2, 0.5, 10.0) == {"min": 2.0, "max": 5.0}
    assert extent(-3.0, 4.0) == {"min": -3.0, "max": 4.0}


def test_a_cam_shows_both_pressure_angles_and_a_sliding_face_none() -> None:
    """A face that slides across its own travel is pushed along it: its pressure angle is 0."""
    names = {}
    for name in ("plate_cam_offset_roller", "flat_follower"):
        facts = built(f"profiles/{name}.toml").facts
        names[name] = {one.meaning for one in facts.shown() if "pressure" in one.meaning}
    assert names == {
        "plate_cam_offset_roller": {"pressure angle, rise", "pressure angle, return"},
        "flat_follower": set(),
    }
