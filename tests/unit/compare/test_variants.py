"""Variants side by side: what is typed, the table, the page."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError
from gearcam.base.facts import Fact, Facts, told_alike
from gearcam.cli import main
from gearcam.compare.page import _over, document, joined
from gearcam.compare.table import lines, rows
from gearcam.compare.variants import Variant, settings_of, variants_of
from helpers_pairs import PROFILES

ELLIPSE = str(PROFILES / "ellipse.toml")
CAM = str(PROFILES / "plate_cam_offset_roller.toml")
THREE = {"law.eccentricity": [0.1, 0.2, 0.3]}
COARSE = {"output.chord_tolerance_mm": [0.01]}


def run(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    code = main(["compare", *words])
    told = capsys.readouterr()
    return code, told.out, told.err


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("law.eccentricity=0.1,0.2", [0.1, 0.2]),
        ("pair.teeth=[20,20],[24, 24]", [[20, 20], [24, 24]]),
        ("law.shape=cosine, cubic", ["cosine", "cubic"]),
        ('law.shape="cosine","cubic"', ["cosine", "cubic"]),
        ("law.ratios[1]=solve,0.4", ["solve", 0.4]),
        (" blank.clearance_bores = true,false", [True, False]),
        ("name=a", ["a"]),
    ],
)
def test_settings_are_read_as_files_hold_values(text: str, values: list[Any]) -> None:
    assert list(settings_of([text]).values()) == [values]


@pytest.mark.parametrize(
    ("texts", "words"),
    [
        (["law.eccentricity"], "is not KEY=VALUE"),
        (["=0.1"], "is not KEY=VALUE"),
        (["law.eccentricity="], "has no value"),
        (["law.eccentricity=0.1,0.1"], "0.1 is listed twice"),
        (["law.eccentricity=0.1", "law.eccentricity=0.2"], "is set twice"),
    ],
)
def test_settings_that_cannot_be_read_are_refused(texts: list[str], words: str) -> None:
    with pytest.raises(DesignError, match=words) as caught:
        settings_of(texts)
    assert caught.value.problems[0].key == "--set"
    assert caught.value.problems[0].allowed


def test_every_combination_of_settings_is_a_variant() -> None:
    settings = {"law.eccentricity": [0.1, 0.2], "pair.module_mm": [1, 2]}
    variants = variants_of([ELLIPSE], settings)
    assert [one.label for one in variants] == [
        "eccentricity=0.1, module_mm=1", "eccentricity=0.1, module_mm=2",
        "eccentricity=0.2, module_mm=1", "eccentricity=0.2, module_mm=2",
    ]  # fmt: skip
    found = [
        (one.result.design.law.eccentricity, one.result.design.pair.module) for one in variants
    ]
    assert found == [(0.1, 1.0), (0.1, 2.0), (0.2, 1.0), (0.2, 2.0)]


def test_labels_are_whole_keys_where_their_ends_are_alike() -> None:
    settings = {"pair.x": [0], "pair.teeth[0]": [20], "pair.teeth[1]": [20, 21]}
    labels = [one.label for one in variants_of([ELLIPSE], settings)]
    assert labels[0] == "pair.x=0, pair.teeth[0]=20, pair.teeth[1]=20"
    settings = {"pair.backlash_mm": [0.1], "limits.backlash_mm": [0.01, 0.02]}
    labels = [one.label for one in variants_of([ELLIPSE], settings)]
    assert labels[1] == "pair.backlash_mm=0.1, limits.backlash_mm=0.02"


def test_files_are_told_apart_by_names_or_else_by_files(tmp_path: Path) -> None:
    other = tmp_path / "other.toml"
    text = Path(ELLIPSE).read_text("utf-8")
    other.write_text(text, "utf-8")
    assert [one.label for one in variants_of([ELLIPSE, str(other)], {})] == [ELLIPSE, str(other)]
    other.write_text(text.replace('"ellipse"', '"other"', 1) + "\n", "utf-8")
    names = {gearcam.load(ELLIPSE).name, gearcam.load(other).name}
    assert {one.label for one in variants_of([ELLIPSE, str(other)], {})} == (
        names if len(names) == 2 else {ELLIPSE, str(other)}
    )


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([ELLIPSE], "nothing to compare with"),
        ([ELLIPSE, "--set", "law.eccentricity=0.1"], "nothing to compare with"),
        ([ELLIPSE, ELLIPSE], "given twice"),
        ([ELLIPSE, CAM], "the first is a gear-pair"),
        ([ELLIPSE, "--set", "law.eccentrcity=0.1,0.2"], "did you mean eccentricity?"),
        ([ELLIPSE, "--set", "law.eccentricity=0.1,x"], "a number from 0 to below 1"),
        ([ELLIPSE, "--set", "law.eccentricity=0.1,2"], "2 is out of range"),
        ([ELLIPSE, "--set", "pair.x=" + ",".join(map(str, range(13)))], "at most 12"),
        ([str(PROFILES / "none.toml"), ELLIPSE], "there is no such file"),
    ],
)
def test_what_cannot_be_compared_is_refused_with_what_is_allowed(
    words: list[str], told: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    code, out, err = run(capsys, *words, "-o", str(tmp_path))
    assert (code, out) == (2, "")
    assert told in err
    assert "Traceback" not in err
    assert list(tmp_path.iterdir()) == []


def test_the_table_marks_what_differs() -> None:
    variants = variants_of([ELLIPSE], {**THREE, **COARSE})
    table = {row.name: row for row in rows(variants)}
    # an ellipse about its focus: the ratio goes from (1 - e)/(1 + e) to its inverse
    wanted = [f"{(1 - e) / (1 + e):.4f} to {(1 + e) / (1 - e):.4f}" for e in (0.1, 0.2, 0.3)]
    assert list(table["pair.ratio"].cells) == wanted
    assert table["pair.ratio"].differs
    assert table["pair.module_mm"].cells == ("1 mm",) * 3
    assert not table["pair.module_mm"].differs
    every = rows(variants, every=True)
    assert {row.name for row in every} >= {*table}
    assert len(every) > 2 * len(table)


def test_the_terminal_shows_what_differs_and_tells_the_rest_briefly() -> None:
    variants = variants_of([ELLIPSE], {**THREE, **COARSE})
    told = list(lines(variants))
    assert all(f"eccentricity=0.{k}" in told[0] for k in (1, 2, 3))
    marked = [line for line in told[1:] if line.startswith("*")]
    assert any("ratio i21" in line for line in marked)
    assert not any("module" in line for line in marked)
    assert "the same in all: module 1 mm" in told[len(marked) + 1]
    every = list(lines(variants, every=True))
    assert any(line.startswith("*  pair.ratio") for line in every)
    assert any(line.startswith("   pair.module_mm") for line in every)


def test_a_variant_that_cannot_be_made_is_told_with_its_reason(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    words = ["--set", "blank.bore_diameter_mm=5,60", "-o", str(tmp_path)]
    code, out, err = run(capsys, ELLIPSE, *words)
    assert (code, err) == (3, "")
    assert "bore_diameter_mm=60: cannot be made" in out
    assert "limit" in out
    text = (tmp_path / "compare.html").read_text("utf-8")
    assert "<b>bore_diameter_mm=60</b> cannot be made" in text
    data = embedded(text)
    assert [line["label"] for line in data["charts"][0]["lines"]] == ["bore_diameter_mm=5"]


def test_nothing_is_written_where_no_variant_can_be_made(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    words = ["--set", "blank.bore_diameter_mm=60,70", "-o", str(tmp_path)]
    code, out, _ = run(capsys, ELLIPSE, *words)
    assert code == 3
    assert out.count("cannot be made") == 2
    assert list(tmp_path.iterdir()) == []


def test_errors_are_the_exit_code(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    words = ["--set", "pair.teeth=[9,9],[20,20]", "-o", str(tmp_path)]
    assert run(capsys, ELLIPSE, *words)[0] == 1
    assert run(capsys, ELLIPSE, "--set", "law.eccentricity=0.1,0.2", "-o", str(tmp_path))[0] == 0


def embedded(text: str) -> dict[str, Any]:
    _, _, rest = text.partition('<script type="application/json" id="document">')
    return json.loads(rest.partition("</script>")[0])


def test_curves_of_variants_stand_in_one_chart() -> None:
    variants = variants_of([ELLIPSE], {**THREE, **COARSE})
    ratio, radii = joined("ratio", variants), joined("radii", variants)
    assert len(ratio.lines) == 3
    for line, e in zip(ratio.lines, (0.1, 0.2, 0.3), strict=True):
        assert line.label.startswith(f"eccentricity={e}")
        # r1 = p/(1 + e*cos) with the near vertex at 0, and r2 = a - r1
        low, high = (1 - e) / (1 + e), (1 + e) / (1 - e)
        np.testing.assert_allclose([line.y.min(), line.y.max()], [low, high], rtol=1e-6)
    assert [line.label.partition(": ")[2] for line in radii.lines] == ["driver", "driven"] * 3


def test_limits_that_differ_are_told_of_whom() -> None:
    settings = {"limits.pressure_angle_deg": [40, 50]}
    (first, second) = joined("pressure_angle", variants_of([ELLIPSE], settings)).limits
    assert first.label == "pressure_angle_deg=40: limit"
    assert (first.value, second.value) == (40.0, 50.0)
    assert len(joined("pressure_angle", variants_of([ELLIPSE], THREE)).limits) == 1


def test_places_are_marked_where_all_variants_have_them() -> None:
    file = str(PROFILES / "nail_machine_two_phase.toml")
    same = variants_of([file], {"blank.bore_diameter_mm": [20, 40]})
    assert [one.value for one in joined("ratio", same).marks] == [160.0]
    knots = {"law.knots_deg": [[0, 150, 360], [0, 160, 360]]}
    assert joined("ratio", variants_of([file], knots)).marks == ()


def moved(variant: Variant, phi1: np.ndarray) -> Any:
    result: Any = variant.result
    return result.motion(phi1)


def test_outlines_are_laid_over_each_other_and_each_moves_by_its_own_law() -> None:
    variants = variants_of([ELLIPSE], {**THREE, **COARSE})
    scene = document(variants, "three")["scene"]
    gears = [one for one in scene["bodies"] if one["name"] == "gear2"]
    assert [bool(one["metal"]) for one in gears] == [True, False, False]
    assert [one["variant"] for one in gears] == [0, 1, 2]
    places = np.radians(np.array(scene["places"]))
    for body, variant in zip(gears, variants, strict=True):
        turn = np.array(body["turn"])
        wanted = moved(variant, places)["phi2_deg"]
        np.testing.assert_allclose(np.degrees(turn - turn[0]), wanted - wanted[0], atol=1e-4)
        chains = body["metal"] or [line["points"] for line in body["lines"] if line["closed"]]
        assert max(map(len, chains)) > 500
    assert not any(line["dashed"] for one in gears[1:] for line in one["lines"])


def test_variants_are_not_coloured_by_what_only_the_first_has() -> None:
    variants = variants_of(
        [str(PROFILES / "plate_cam_offset_roller.toml")], {"cam.prime_radius_mm": [30, 35]}
    )
    assert all(one.scene is not None and one.scene.coloured for one in variants)
    scene = document(variants, "two")["scene"]
    assert (scene["coloured"], scene["scales"]) == ([], {})


def test_ways_of_different_length_are_shown_over_the_longest() -> None:
    files = [str(PROFILES / f"{name}.toml") for name in ("furnace_door_two_phase", "furnace_door")]
    variants = variants_of(files, COARSE)
    ends = [one.scene.places[-1] for one in variants if one.scene is not None]
    assert ends[0] < ends[1]
    scene = document(variants, "two")["scene"]
    assert scene["places"][-1] == pytest.approx(ends[1], abs=1e-4)
    places = np.array(scene["places"])
    gears = [one for one in scene["bodies"] if one["name"] == "gear2"]
    for body, variant, end in zip(gears, variants, ends, strict=True):
        turn = np.degrees(np.array(body["turn"]))
        wanted = moved(variant, np.radians(np.minimum(places, end)))["phi2_deg"]
        np.testing.assert_allclose(turn - turn[0], wanted - wanted[0], atol=0.01)  # between places


def test_what_repeats_goes_on_where_another_is_still_on_its_way() -> None:
    (variant, _) = variants_of([ELLIPSE], {"law.eccentricity": [0.3, 0.1], **COARSE})
    assert variant.scene is not None
    places = np.linspace(0.0, 900.0, 1801)
    body = next(one for one in _over(variant.scene, places).bodies if one.name == "gear2")
    wanted = moved(variant, np.radians(places))["phi2_deg"]
    np.testing.assert_allclose(
        np.degrees(body.pose.turn - body.pose.turn[0]), wanted - wanted[0], atol=1e-3
    )


def test_a_driver_of_another_way_is_told_and_not_drawn() -> None:
    files = [CAM, str(PROFILES / "translating_cam.toml")]
    shown = document(variants_of(files, {}), "two")
    assert "not drawn with the others" in shown["blocks"]["verdict"]
    assert len([one for one in shown["scene"]["bodies"] if one["name"] == "cam"]) == 1


def test_the_page_tells_the_facts(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    run(capsys, ELLIPSE, "--set", "law.eccentricity=0.1,0.2", "-o", str(tmp_path))
    facts = embedded((tmp_path / "compare.html").read_text("utf-8"))["blocks"]["facts"]
    assert "0.8182 to 1.2222" in facts
    assert "0.6667 to 1.5000" in facts
    assert facts.count('class="differs"') > 5


def test_compare_does_not_touch_other_files(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / "mine.txt").write_text("kept")
    (tmp_path / "summary.json").write_text('{"files": {"mine.txt": "of an earlier build"}}')
    run(capsys, ELLIPSE, "--set", "law.eccentricity=0.1,0.2", "-o", str(tmp_path))
    names = sorted(one.name for one in tmp_path.iterdir())
    assert names == ["compare.html", "mine.txt", "summary.json"]


def test_a_fact_of_variants_has_one_unit_and_equal_decimals() -> None:
    def told(*values: Any, **more: Any) -> list[str]:
        return told_alike([Facts({"a_mm_s2": Fact(v, **more)}).quantity("a_mm_s2") for v in values])

    assert told(9000.0, 123456.7) == ["9.00 m/s2", "123.46 m/s2"]
    assert told({"min": 0.0, "max": 20.5}, {"min": 1.0, "max": 23456.7}) == [
        "0 to 0.0205 m/s2",
        "0.001 to 23.46 m/s2",
    ]
    assert told(5.0, 3.25, text="some") == ["some mm/s2", "some mm/s2"]
    # what breaks its limit looks unlike it, with more digits
    assert told(2.0000001, 5.25, at_most=2.0)[0] == "2.0000001 mm/s2"


def test_charts_are_in_inches_if_all_designs_are() -> None:
    base = gearcam.load(PROFILES / "tappet.toml")
    results = [gearcam.build(base.with_({"output.units": one})) for one in ("inch", "inch", "mm")]
    variants = [
        Variant(label=f"{k}", result=one, scene=one.scene()) for k, one in enumerate(results)
    ]
    labels = [
        " ".join(one["y"] for one in document(chosen, title="t")["charts"])
        for chosen in (variants[:2], variants[1:])
    ]
    assert re.search(r", in\b.*, 1/in\b", labels[0])
    assert not re.search(r"[mu]m\b|1/m", labels[0])
    assert not re.search(r"\bin\b", labels[1])
    assert rows(variants[:2])
