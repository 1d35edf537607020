"""What cannot be a ring, by reading and by computing, with what is allowed instead."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError, Problem
from gearcam.base.tolerances import DEFAULT
from gearcam.designs.writing import toml_text
from gearcam.gears.pair import GearPair, lobes_of
from gearcam.laws.ratio.span import RING, Lobes

ELLIPSE = {"type": "ellipse", "eccentricity": 0.1}


def built(law: dict[str, Any], teeth: Sequence[float], **tables: Any) -> GearPair:
    pair = {"type": "internal", "module_mm": 2, "teeth": teeth} | tables.pop("pair", {})
    document = {"kind": "gear-pair", "name": "ring", "law": law, "pair": pair, **tables}
    return gc.build(gc.loads(toml_text(document))).pair


def only(caught: pytest.ExceptionInfo[DesignError]) -> Problem:
    (problem,) = caught.value.problems
    return problem


@pytest.mark.parametrize(
    ("key", "value"),
    [("outer", "follow"), ("rim_mm", 5), ("outer_diameter_mm", 130), ("cutter_teeth", 30)],
)
def test_an_external_pair_has_no_ring(key: str, value: Any) -> None:
    assert built(ELLIPSE, [24, 48], ring={key: value}).internal
    with pytest.raises(DesignError) as caught:
        built(ELLIPSE, [24, 48], pair={"type": "external"}, ring={key: value})
    problem = only(caught)
    assert (problem.key, problem.value) == (f"ring.{key}", value)
    assert 'pair.type = "internal"' in problem.allowed


def test_an_external_pair_may_say_what_is_usual_of_a_ring() -> None:
    """A design made in Python says so when it is turned into a document."""
    assert not built(ELLIPSE, [24, 48], pair={"type": "external"}, ring={"outer": "round"}).internal


@pytest.mark.parametrize(
    ("beside", "message"),
    [
        ({"rim_mm": 5}, "130: is given beside rim_mm = 5"),
        ({"outer": "follow"}, '130: does not apply with outer = "follow"'),
    ],
)
def test_a_diameter_is_that_of_a_round_outside_without_a_rim(
    beside: dict[str, Any], message: str
) -> None:
    with pytest.raises(DesignError, match=message) as caught:
        built(ELLIPSE, [24, 48], ring={"outer_diameter_mm": 130, **beside})
    assert only(caught).key == "ring.outer_diameter_mm"


def test_the_ring_comes_second() -> None:
    with pytest.raises(InfeasibleError, match=r"teeth = \[24, 48\] with the inverse law"):
        built(ELLIPSE, [48, 24])
    assert built(ELLIPSE, [24, 48]).internal


@pytest.mark.parametrize("lobes", [[2, 1], [48, 24]])
def test_lobes_are_swapped_with_the_teeth_of_a_ring_given_first(lobes: list[int]) -> None:
    made: dict[str, Any] = {"kind": "gear-pair", "name": "r"}
    made["law"] = {"type": "lobed", "eccentricity": 0.05, "lobes": lobes}
    made["pair"] = {"type": "internal", "module_mm": 2, "teeth": [48, 24]}
    found = gc.remedies(gc.build(gc.design(made))).found
    assert {"pair.teeth": [24, 48], "law.lobes": [1, 2]} in [one.changes for one in found]


def test_swapped_lobes_are_kept_where_they_fit() -> None:
    """[2, 4] for [4, 2]; in lowest terms too."""
    made: dict[str, Any] = {"kind": "gear-pair", "name": "r"}
    made["pair"] = {"module_mm": 2, "teeth": [40, 80]}
    made["law"] = {"type": "lobed", "eccentricity": 0.05, "lobes": [4, 2]}
    found = gc.remedies(gc.build(gc.design(made))).found
    assert [one.changes for one in found] == [{"law.lobes": [2, 4]}, {"law.lobes": [1, 2]}]


def test_the_inverse_of_a_law_is_that_of_the_ring_given_second() -> None:
    """Where the ratio is i at phi1 and phi2 it is 1/i at phi2 and phi1 then, as is told."""
    driver = gc.laws.Formula(ratio="1 + 0.2*cos(2*phi1)").build(Lobes(2, 1), DEFAULT)
    phi = [math.pi * k / 32 for k in range(33)]
    phi2 = [0.0, *(float(driver.phi2(angle)) for angle in phi[1:-1]), 2 * math.pi]
    degrees = {"phi1_deg": phi2, "phi2_deg": phi}
    table = {key: [math.degrees(one) for one in row] for key, row in degrees.items()}
    law = built({"type": "table"} | table, [30, 60]).law
    for k in (3, 17, 30):
        ratio = float(driver.ratio(phi[k]))
        assert float(law.ratio(phi2[k])) == pytest.approx(1 / ratio, rel=1e-4)  # of 33 points


def test_equal_counts_have_no_closed_internal_pair_but_an_open_one() -> None:
    with pytest.raises(InfeasibleError, match="an internal pair cannot have equal tooth counts"):
        built({"type": "constant"}, [30, 30])
    open_one = {"type": "log-spiral", "ratios": [0.3, 0.5], "driven_travel_deg": 60}
    assert built(open_one, [30, 30]).internal


@pytest.mark.parametrize(
    "law",
    [
        {"type": "formula", "r1": "1 + 0.1*cos(phi1)"},
        {"type": "formula", "phi2": "phi1 + 0.01*sin(phi1)"},
    ],
)
def test_a_ring_turns_less_than_its_wheel(law: dict[str, Any]) -> None:
    travels = {"driver_travel_deg": 90, "driven_travel_deg": 91}
    with pytest.raises(InfeasibleError, match="a ring must turn less than its wheel") as caught:
        built(law | travels, [30, 30])
    assert caught.value.limit == pytest.approx(90.0)
    if "r1" in law:
        assert built(law | travels | {"driven_travel_deg": 89.9}, [30, 30]).internal


def test_a_ratio_stays_below_one_by_the_share_that_is_told() -> None:
    def harmonics(share: float) -> None:
        built({"type": "fourier", "cosines": [0.6 * share], "sines": [0.3 * share]}, [400, 600])

    with pytest.raises(InfeasibleError, match="must stay below 1") as caught:
        harmonics(1.0)
    found = re.search(r"mean of (\S+),.* less than (\S+) times", str(caught.value))
    assert found
    mean, share = (float(number) for number in found.groups())
    assert mean == pytest.approx(2 / 3, abs=1e-6)
    assert share == pytest.approx(0.5 / math.hypot(0.6, 0.3), abs=1e-6)
    with pytest.raises(InfeasibleError, match="must stay below 1"):
        harmonics(share * 1.001)
    with pytest.raises(InfeasibleError, match="concave"):  # as high as that, wheels are no wheels
        harmonics(share * 0.999)


def test_ratios_of_a_spiral_stay_below_one() -> None:
    spiral = {"type": "log-spiral", "driven_travel_deg": 60}
    for ratios, place in (([0.3, 1], 1), ([1.2, 0.5], 0)):
        with pytest.raises(InfeasibleError, match="must stay below 1") as caught:
            built(spiral | {"ratios": ratios}, [30, 30])
        assert caught.value.where == f"law.ratios[{place}]"
    assert built(spiral | {"ratios": [0.3, 0.9]}, [30, 30]).internal


def test_a_rack_has_no_inside() -> None:
    with pytest.raises(InfeasibleError, match="a rack cannot be an internal pair"):
        built({"type": "rack", "r1": "1 + 0.1*cos(phi1)"}, [20, 30])


def test_a_slide_has_no_ring() -> None:
    slide = {"type": "motion", "slide": "1 - cos(phi1)", "rod": 4}
    with pytest.raises(InfeasibleError, match="and the pair is external"):
        built(slide, [20, 40])


def test_corners_no_rounder_than_a_circular_wheel() -> None:
    polygon = {"type": "rounded-polygon", "corners": 4}
    with pytest.raises(InfeasibleError, match="larger than that of a circular wheel") as caught:
        built(polygon | {"corner_radius": 5}, [40, 50])
    assert caught.value.limit == pytest.approx(4.0)
    assert built(polygon | {"corner_radius": 3.9}, [80, 100]).internal


def test_lobes_know_their_mate() -> None:
    spec = gc.PairSpec(type="internal", teeth=(24, 36), module=1.0)
    assert lobes_of(spec) == Lobes(2, 3, RING)


@pytest.mark.parametrize("kind", ["internal", "external", "planetary"])
@pytest.mark.parametrize("teeth", [[24, 24, 78], [24, 24, 0.5]])
def test_a_planet_on_a_carrier_is_refused(teeth: list[float], kind: str) -> None:
    with pytest.raises(DesignError, match="a planet between sun and ring on a carrier") as caught:
        built(ELLIPSE, teeth, pair={"type": kind})
    assert only(caught).key == "pair.teeth"
    assert "two tooth counts, driver first" in only(caught).allowed
    assert "sun + 2*planet teeth" in only(caught).hint


@pytest.mark.parametrize("teeth", [[24, 48], "many"])
def test_a_planetary_pair_is_refused_whatever_its_teeth(teeth: Any) -> None:
    with pytest.raises(DesignError, match="a planet between sun and ring on a carrier") as caught:
        built(ELLIPSE, teeth, pair={"type": "planetary"})
    assert only(caught).key == "pair"


def test_a_planet_wished_for_in_python_is_refused_alike() -> None:
    pair = gc.PairSpec(type="planetary", teeth=(24, 24, 78), module=2.0)  # pyright: ignore[reportArgumentType]
    with pytest.raises(DesignError, match="a planet between sun and ring on a carrier"):
        gc.build(gc.GearPairDesign(name="set", law=gc.laws.Constant(), pair=pair))
