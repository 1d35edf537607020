"""Labels of keys and facts on the page of a sweep."""

from __future__ import annotations

import pytest

import helpers_built
from gearcam.base.facts import Facts
from gearcam.sweeps.words import labels
from helpers_pairs import PROFILES

NONE = Facts({})


@pytest.mark.parametrize(
    ("key", "label", "unit"),
    [
        ("law.eccentricity", "eccentricity", ""),
        ("cam.prime_radius_mm", "prime radius", "mm"),
        ("phases[1].to_deg", "phase 2, to", "deg"),
        ("linkage.cranks[0].length_mm", "crank 1, length", "mm"),
        ("pair.teeth[1]", "teeth, 2", ""),
        ("name", "name", ""),
    ],
)
def test_keys_are_words(key: str, label: str, unit: str) -> None:
    assert labels(NONE, [key]) == {key: (label, unit)}


def test_facts_have_their_meanings() -> None:
    facts = helpers_built.built(PROFILES / "ellipse.toml").facts
    names = ["pair.ratio.max", "mesh.tip_thickness_min_mm", "mesh.contact_ratio.forward.mean"]
    assert [*labels(facts, names).values()] == [
        ("largest ratio i21", ""),
        ("thinnest tip", "mm"),
        ("mean contact ratio", ""),
    ]


def test_a_fact_without_a_meaning_has_that_of_the_quantity_above_it() -> None:
    facts = helpers_built.built(PROFILES / "groove_cam.toml").facts
    names = ["cam.pressure_angle_deg.max", "cam.pressure_angle_deg.rise.min"]
    assert [*labels(facts, names).values()] == [
        ("largest pressure angle", "deg"),
        ("least pressure angle, rise", "deg"),
    ]


def test_labels_that_are_the_same_are_told_apart() -> None:
    facts = helpers_built.built(PROFILES / "ellipse.toml").facts
    names = [f"mesh.contact_ratio.{way}.least" for way in ("forward", "backward")]
    names += [f"gears.{k}.cutter_tip_radius_mm" for k in (0, 1)]
    assert [label for label, _ in labels(facts, names).values()] == [
        "least contact ratio, forward",
        "least contact ratio, backward",
        "cutter tip radius, wheel 1",
        "cutter tip radius, wheel 2",
    ]


@pytest.mark.parametrize("name", ["ellipse", "cylinder_cam", "nail_machine_slide", "groove_cam"])
def test_no_two_labels_are_the_same(name: str) -> None:
    result = helpers_built.built(PROFILES / f"{name}.toml")
    found = labels(result.facts, result.record())
    assert len(set(found.values())) == len(found)
    # but in names that people gave, which follow a colon
    assert not [one for one, _ in found.values() if "_" in one.partition(":")[0]]
