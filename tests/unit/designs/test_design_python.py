"""A design made in Python meets the same rules as one that is read."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gearcam as gc
from gearcam.base.errors import DesignError
from gearcam.designs import document_of, loads
from gearcam.gears.spec import PairSpec
from gearcam.kinds.gear_pair.design import GearPairDesign, PairOutputSpec
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.phases import Phases
from helpers_files import PAIR


def test_a_design_made_in_python_equals_the_one_read() -> None:
    read = loads(PAIR)
    assert isinstance(read, GearPairDesign)
    made = GearPairDesign(
        name="good",
        law=Phases(knots=(0.0, math.radians(160), 2 * math.pi), ratios=(1.6, 0.4, 1.6)),
        pair=PairSpec(center_distance=180.0, teeth=(36, 36)),
        output=PairOutputSpec(files=("csv",)),
    )
    assert (made.law, made.pair, made.rack, made.output) == (
        read.law,
        read.pair,
        read.rack,
        read.output,
    )
    assert made.source == ""
    assert document_of(made) == document_of(read)


def test_none_leaves_a_value_out_as_a_missing_key_does() -> None:
    def made(**blank: Any) -> GearPairDesign:
        pair = PairSpec(module=2.0, teeth=(21, 21))
        return GearPairDesign(name="n", law=Ellipse(eccentricity=0.2), pair=pair, **blank)

    names = [one.name for one in fields(gc.Blank)]
    assert made(blank=gc.Blank(**dict.fromkeys(names))) == made()
    halves = {"bore_diameter": (None, 8.0), "shaft": ("TT", None), "bolt_circle": (None, None)}
    whole: Any = {"bore_diameter": (0.0, 8.0), "shaft": ("TT", "none"), "bolt_circle": (0.0, 0.0)}
    assert made(blank=gc.Blank(**halves)).blank == gc.Blank(**whole)
    notes: Any = {"material": ("C45E", None)}
    assert made(drawing=gc.PairDrawingSpec(**notes)).drawing.material == ("C45E", "")
    with pytest.raises(DesignError, match="above 0"):
        made(blank=gc.Blank(density=(None, 7850.0)))


def test_a_design_made_in_python_meets_the_same_rules() -> None:
    good: dict[str, Any] = {
        "name": "e",
        "law": Ellipse(eccentricity=0.3),
        "pair": PairSpec(module=1.0, teeth=(41, 41)),
    }

    def refused(words: str, **changes: Any) -> DesignError:
        with pytest.raises(DesignError, match=words) as caught:
            GearPairDesign(**{**good, **changes})
        return caught.value

    assert GearPairDesign(**good).kind == "gear-pair"
    both = PairSpec(module=1.0, center_distance=1.0, teeth=(41, 41))
    assert refused("exactly one", pair=both).problems[0].line is None
    refused("out of range", law=Ellipse(eccentricity=1.0))
    refused("instance of Phases or .* or Ellipse or ", law="ellipse")
    refused("instance of PairSpec", pair=3)
    refused(r"limits\.no_such", limits={"no_such": 1.0})
    refused(r"limits\.tip_thickness", limits={"tip_thickness": -1.0})
    assert GearPairDesign(**good, limits={"backlash": 0.1}).limits == {"backlash": 0.1}


def test_numbers_from_numpy_serve_in_python() -> None:
    knots = tuple(np.radians([0.0, 160.0, 360.0]))
    design = GearPairDesign(
        name="n",
        law=Phases(knots=knots, ratios=tuple(np.array([1.6, 0.4, 1.6]))),
        pair=PairSpec(center_distance=np.float64(180), teeth=tuple(np.array([36, 36]))),  # pyright: ignore
    )
    assert document_of(design)["law"]["knots_deg"] == [0.0, 160.0, 360.0]


@settings(deadline=None)
@given(st.floats(min_value=5, max_value=35))
def test_degrees_keep_their_range_through_radians(angle: float) -> None:
    rack = f"\n[rack]\npressure_angle_deg = {angle!r}\n"
    design = loads(PAIR.replace("[output]", rack + "[output]"))
    assert document_of(design)["rack"]["pressure_angle_deg"] == pytest.approx(angle, rel=1e-12)


def test_changes_within_a_table_that_is_given_leave_it_as_it_is() -> None:
    law = {"type": "ellipse", "eccentricity": 0.3}
    made: Any = gc.load("profiles/ellipse.toml").with_({"law": law, "law.eccentricity": 0.2})
    assert made.law.eccentricity == 0.2
    assert law == {"type": "ellipse", "eccentricity": 0.3}
