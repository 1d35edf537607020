"""What numbers are called beside their sliders, and which have none."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

from gearcam.view.names import title_of
from gearcam.view.numbers import numbers
from gearcam.view.work import show
from helpers_pairs import PROFILES


@cache
def sliders_of(name: str) -> dict[str, dict[str, Any]]:
    """The sliders of a profile as the live view makes them, by key."""
    path = PROFILES / f"{name}.toml"
    reply = show(path.read_bytes(), str(path))
    assert reply["error"] == ""
    return {one["key"]: one for one in reply["sliders"]}


@pytest.mark.parametrize(
    ("name", "key", "group", "label"),
    [
        ("nail_machine_two_phase", "law.knots_deg[1]", "law", "knot 2 of 3"),
        ("nail_machine_two_phase", "law.ratios[0]", "law", "ratios 1 and 3 of 3"),
        ("nail_machine_two_phase", "law.ratios[1]", "law", "ratio 2 of 3"),
        ("nail_machine_two_phase", "pair.center_distance_mm", "pair", "centre distance"),
        ("nail_machine_two_phase", "pair.teeth[0]", "pair", "teeth, wheel 1 and wheel 2"),
        (
            "nail_machine_two_phase", "blank.bore_diameter_mm[1]",
            "blank", "bore diameter, wheel 2",
        ),
        ("nail_machine_slide", "crank[0].length_mm", 'crank "pin"', "length"),
        ("nail_machine_slide", "dyad[0].lengths_mm[1]", 'dyad "slide"', "length of ram"),
        ("nail_machine_slide", "load[0].force_n", 'load on "slide"', "force"),
        ("dwell_linkage", "joint[1].at_mm[0]", 'joint "G"', "at, x"),
        (
            "drum_pusher", "drive[0].cam.motion[2].angle_deg",
            'drive "drum", cam, phase 3 of 4: return', "angle",
        ),
        ("drum_pusher", "drive[0].cam.cam.length_mm", 'drive "drum", cam', "length"),
        ("conjugate_cams", "motion[0].lift_deg", "phase 1 of 4: rise", "lift"),
        ("conjugate_cams", "cam.prime_radius2_mm", "cam", "prime radius 2"),
        ("carton_pusher", "friction.journal_radius_mm[1]", "friction", "journal radius, pin"),
        ("bspline", "law.radii[1]", "law", "radius 2 of 4"),
    ],
)  # fmt: skip
def test_numbers_are_called_by_names_of_the_file_and_by_words(
    name: str, key: str, group: str, label: str
) -> None:
    found = sliders_of(name)[key]
    assert (found["group"], found["label"]) == (group, label)


@pytest.mark.parametrize(
    ("name", "without"),
    [
        # the ends of a turn, the last ratio with the first, the teeth of equal wheels
        (
            "nail_machine_two_phase",
            {"law.knots_deg[0]", "law.knots_deg[2]", "law.ratios[2]", "pair.teeth[1]"},
        ),
        # these fill a turn together
        (
            "two_speeds",
            {"law.angles_deg[0]", "law.angles_deg[1]", "law.transition_deg", "pair.teeth[1]"},
        ),
        # a limacon has one lobe: only multiples are possible
        ("limacon", {"pair.teeth[0]", "pair.teeth[1]"}),
        # equal by chance
        ("askew_pair", set()),
        ("nail_machine_slide", set()),
    ],
)
def test_numbers_that_cannot_move_alone_have_no_slider(name: str, without: set[str]) -> None:
    every = set(numbers((PROFILES / f"{name}.toml").read_text("utf-8")))
    assert every - set(sliders_of(name)) == without


def test_a_name_that_two_items_have_is_numbered() -> None:
    document = {"load": [{"on": "slide"}, {"on": "slide"}, {}], "crank": [{"joint": "B"}]}
    assert title_of(document, ("load", 1)) == 'load on "slide" (2 of 2)'
    assert title_of(document, ("load", 2)) == "load 3 of 3"
    assert title_of(document, ("crank", 0)) == 'crank "B"'
    assert title_of(document, ()) == ""
