"""The schema of design files and the reader agree, judged by another implementation of schemas."""

from __future__ import annotations

import copy
import json
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from claims.laws import LAW_CLAIMS
from claims.motion import MOTION_CLAIMS
from gearcam.designs import load
from gearcam.designs.design import functions_in
from gearcam.designs.examine import examine
from gearcam.designs.kind import KINDS
from gearcam.designs.schema import schema
from gearcam.designs.template import template
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import PHASES
from gearcam.laws.ratio import LAWS
from helpers_pairs import PROFILES
from helpers_tables import WITH_LAW, index_table, law_table, phase_table, rise_table, turn_tables

FILES = sorted(PROFILES.glob("*.toml"))
GOOD: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "good",
    "law": {"type": "phases", "knots_deg": [0, 160, 360], "ratios": [1.6, "solve", 1.6]},
    "pair": {"center_distance_mm": 180, "teeth": [36, 36], "face_width_mm": 10},
    "rack": {"pressure_angle_deg": 20, "addendum": 1, "dedendum": 1.25, "tip_radius": 0.3},
    "blank": {"bore_diameter_mm": [20, 20]},
    "output": {"files": ["csv"], "chord_tolerance_mm": 0.01, "dxf_curves": "lines"},
}
CAM: dict[str, Any] = {
    "kind": "cam",
    "name": "good",
    "motion": [
        {"type": "rise", "law": "scca", "angle_deg": 90, "lift_mm": 10, "b": 0, "c": 0.5, "d": 0.5},
        {"type": "dwell", "angle_deg": 90},
        {"type": "return", "law": "cycloidal", "angle_deg": 90, "lift_mm": 6},
        {"type": "segment", "angle_deg": 90, "to_mm": 0},
    ],
    "follower": {"type": "roller", "roller_radius_mm": 6, "offset_mm": 2},
    "cam": {"form": "disc", "prime_radius_mm": 40, "rotation": "cw"},
    "blank": {"bore_diameter_mm": 20, "bolts": 0},
    "output": {"files": ["csv"], "motion_step_deg": 1, "inspection_points": 90},
    "limits": {"wall_mm": 2},
}


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    made = schema()
    jsonschema.Draft202012Validator.check_schema(made)
    return jsonschema.Draft202012Validator(made)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_profile_is_valid(validator: jsonschema.Draft202012Validator, path: Path) -> None:
    validator.validate(tomllib.loads(path.read_text("utf-8")))
    load(path)


@pytest.mark.parametrize("kind", list(KINDS))
def test_the_template_is_valid(validator: jsonschema.Draft202012Validator, kind: str) -> None:
    validator.validate(tomllib.loads(template(kind)))


def test_every_key_is_described_and_no_other_is_allowed(
    validator: jsonschema.Draft202012Validator,
) -> None:
    definitions = {
        name: made.get("items", made)  # of tables that may stand several times
        for name, made in validator.schema["$defs"].items()  # type: ignore[index]
        if not name.startswith("inch-")
    }
    expected: dict[str, set[str]] = {}
    for name, kind in KINDS.items():
        expected[name] = set(kind.titles)
        for title in (*kind.tables, "limits"):
            expected[f"{name}-{title}"] = set(kind.table(title).entries)
    expected |= {f"law-{name}": {"type", *law_table(name).entries} for name in LAWS}
    expected |= {f"index-{law}": {"law", *index_table(law).entries} for law in MOTION_LAWS}
    for title, known in zip(("motion-2", "motion-1"), turn_tables(), strict=True):
        expected[title] = set(known.entries)
    for name in PHASES:
        if name not in WITH_LAW:
            expected[f"motion-{name}"] = {"type", *phase_table(name).entries}
            continue
        assert set(definitions.pop(f"motion-{name}")["properties"]) == {
            "law"
        }  # what chooses among these:
        for law in MOTION_LAWS:
            keys = {"type", "law", *phase_table(name).entries, *rise_table(law).entries}
            expected[f"motion-{name}-{law}"] = keys
    assert {name: set(made["properties"]) for name, made in definitions.items()} == expected
    for name, made in definitions.items():
        assert made["additionalProperties"] is False
        for key, rule in made["properties"].items():
            told = rule.get("description") or rule.get("const") or "$ref" in rule
            assert told, f"{name}.{key}"


def test_what_the_design_decides_has_no_default(
    validator: jsonschema.Draft202012Validator,
) -> None:
    limits = validator.schema["$defs"]["cam-limits"]["properties"]  # type: ignore[index]
    assert "default" not in limits["pressure_angle_deg"]
    assert limits["wall_mm"]["default"] == 1.0
    assert "NaN" not in json.dumps(validator.schema)


@pytest.mark.parametrize("name", list(LAWS))
def test_every_law_has_a_branch_that_takes_its_examples(
    validator: jsonschema.Draft202012Validator, name: str
) -> None:
    for claim in LAW_CLAIMS[name].values:
        values = vars(claim.parameters)
        law = {"type": name} | law_table(name).outward(values)
        if any(functions_in(law)):
            continue  # which no file can hold
        validator.validate(GOOD | {"law": law})
        assert not list(validator.iter_errors(GOOD | {"law": law}))
        assert list(validator.iter_errors(GOOD | {"law": law | {"no_such_key": 1}}))


@pytest.mark.parametrize("phase", WITH_LAW)
def test_every_rise_has_branches_that_take_its_examples(
    validator: jsonschema.Draft202012Validator, phase: str
) -> None:
    number = [item["type"] for item in CAM["motion"]].index(phase)
    for law, claims in MOTION_CLAIMS.items():
        for claim in claims.values:
            own = rise_table(law).document(claim.parameters)
            if any(functions_in(own)):
                continue
            made = {"type": phase, "law": law, "angle_deg": 90, "lift_mm": 10, **own}
            document = copy.deepcopy(CAM)
            document["motion"][number] = made
            assert not list(validator.iter_errors(document)), law
            document["motion"][number] = made | {"no_such_key": 1}
            assert list(validator.iter_errors(document)), law


VALUES = st.one_of(
    st.sampled_from(
        [
            *(0, -1, 1, 2, 3, 36, 5.0, 0.5, 400, 1e9, True, "solve", "lines", "csv", "x", "cubic"),
            *(
                [],
                [36, 36],
                [2, 36],
                ["csv"],
                ["csv", "csv"],
                ["dxf", "x"],
                [0, "solve"],
                [1, 2, 3],
            ),
            *({}, {"type": "ellipse"}, {"type": "ellipse", "eccentricity": 0.5}, {"type": "x"}),
        ]
    )
)
PLACES = st.sampled_from(
    [(title,) for title in GOOD]
    + [(title, key) for title, known in GOOD.items() if isinstance(known, dict) for key in known]
    + [(title, "no_such_key") for title in ("law", "pair", "rack", "blank", "output")]
    + [("no_such_key",), ("pair", "module_mm"), ("law", "shape"), ("law", "eccentricity")]
)


Edits = list[tuple[tuple[Any, ...], Any]]


def _edited(edits: Edits, good: dict[str, Any] = GOOD) -> dict[str, Any]:
    document = copy.deepcopy(good)
    for place, value in edits:
        target: Any = document
        for step in place[:-1]:
            inside = isinstance(step, int) and isinstance(target, list) and step < len(target)
            target = target[step] if inside else _get(target, step)
        if isinstance(target, dict):
            if value is None:
                target.pop(place[-1], None)
            else:
                target[place[-1]] = copy.deepcopy(value)
    return document


def _get(target: Any, key: Any) -> Any:
    return target.get(key) if isinstance(target, dict) else None


# what a schema cannot know: relations between values, and numbers that only TOML tells apart
BEYOND = ("ratios for", "knots must", "first knot", "last ratio", "more than one", "too coarse")


EDITS = st.lists(st.tuples(PLACES, VALUES | st.none()), min_size=1, max_size=3)


@given(EDITS)
@settings(max_examples=80, deadline=None)
def test_reader_and_schema_refuse_the_same_files(edits: Edits) -> None:
    demand_the_same(edits)


@pytest.mark.slow
@given(EDITS)
@settings(max_examples=1000, deadline=None)
def test_reader_and_schema_refuse_the_same_of_many_files(edits: Edits) -> None:
    demand_the_same(edits)


def demand_the_same(edits: Edits) -> None:
    document = _edited(edits)
    faults = examine(document, stem="file").faults
    told = [fault for fault in faults if not any(words in fault.message for words in BEYOND)]
    errors = list(SHARED.iter_errors(_whole_numbers_apart(document)))
    assert bool(told) == bool(errors), (document, told, errors)


CAM_VALUES = st.sampled_from(
    [
        *(0, -1, 1, 2, 45, 90, 0.5, 400, 1e9, True, "x", "csv", "rise", "dwell", "return"),
        *("segment", "cycloidal", "scca", "roller", "flat", "point", "oscillating", "disc"),
        *("groove", "ccw", [], [2, 3], ["csv"], ["csv", "csv"], ["tool-path"], ["x"], {}),
        *({"type": "dwell", "angle_deg": 90}, [{"type": "dwell", "angle_deg": 360}]),
        *({"type": "roller", "roller_radius_mm": 3}, [3], [{"angle_deg": 360}]),
    ]
)
CAM_PLACES = st.sampled_from(
    [(title,) for title in CAM]
    + [(title, key) for title, known in CAM.items() if isinstance(known, dict) for key in known]
    + [("motion", k, key) for k, phase in enumerate(CAM["motion"]) for key in phase]
    + [("motion", k, "no_such_key") for k in range(4)]
    + [("motion", k, key) for k in range(4) for key in ("lift_deg", "to_deg", "q", "law")]
    + [(title, "no_such_key") for title in CAM if isinstance(CAM[title], dict)]
    + [("cam", "base_radius_mm"), ("follower", "arm_mm"), ("output", "tool_radius_mm")]
    + [("no_such_key",), ("law",), ("limits", "pressure_angle_deg"), ("blank", "stop_pin_mm")]
)
# relations between values: whether a schema refuses these files too is left open
BEYOND_CAMS = (
    *("wrong unit", "the phases take", "nothing to return from", "never moves", "ends at a lift"),
    *("follower", "b + c + d", "is missing beside"),
)


CAM_EDITS = st.lists(st.tuples(CAM_PLACES, CAM_VALUES | st.none()), min_size=1, max_size=3)


@given(CAM_EDITS)
@settings(max_examples=80, deadline=None)
def test_reader_and_schema_refuse_the_same_cams(edits: Edits) -> None:
    demand_the_same_of_cams(edits)


@pytest.mark.slow
@given(CAM_EDITS)
@settings(max_examples=1000, deadline=None)
def test_reader_and_schema_refuse_the_same_of_many_cams(edits: Edits) -> None:
    demand_the_same_of_cams(edits)


def demand_the_same_of_cams(edits: Edits) -> None:
    document = _edited(edits, CAM)
    faults = examine(document, stem="file").faults
    told = [fault for fault in faults if not any(words in fault.message for words in BEYOND_CAMS)]
    errors = list(SHARED.iter_errors(document))
    if told or not faults:
        assert bool(told) == bool(errors), (document, told, errors)


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("motion",), None),
        (("motion",), []),
        (("motion",), [3]),
        (("motion",), {"type": "dwell", "angle_deg": 360}),
        (("motion", 0, "type"), "raise"),
        (("motion", 0, "type"), None),
        (("motion", 0, "law"), "cycloid"),
        (("motion", 0, "law"), None),
        (("motion", 0, "law"), "cycloidal"),
        (("motion", 0, "lift_mm"), None),
        (("motion", 0, "lift_mm"), 0),
        (("motion", 0, "lift_deg"), 10),
        (("motion", 0, "angle_deg"), 361),
        (("motion", 0, "angle_deg"), "solve"),
        (("motion", 0, "b"), None),
        (("motion", 1, "lift_mm"), 10),
        (("motion", 1, "law"), "cycloidal"),
        (("motion", 2, "lift_deg"), 10),
        (("motion", 3, "to_mm"), None),
        (("follower", "type"), "ball"),
        (("follower",), None),
        (("cam", "form"), "cylinder"),
        (("cam", "prime_radius_mm"), None),
        (("cam", "base_radius_mm"), 30),
        (("blank", "bore_diameter_mm"), [20, 20]),
        (("blank", "timing_marks"), True),
        (("output", "files"), ["csv", "csv"]),
        (("output", "phi1_deg"), 3),
        (("limits", "closure_deg"), 0.1),
        (("law",), {"type": "constant"}),
        (("kind",), "gear-pair"),
        (("kind",), None),
    ],
)
def test_both_refuse_a_cam(place: tuple[Any, ...], value: Any) -> None:
    document = _edited([(place, value)], CAM)
    assert examine(document).faults
    assert not SHARED.is_valid(document)


ROWS = {"theta_deg": [0, 60, 120, 180, 240, 300], "lift_mm": [0, 2, 4, 6, 4, 2]}


@pytest.mark.parametrize(
    ("motion", "good"),
    [
        (ROWS, True),
        (ROWS | {"smoothing_tolerance_mm": 0.1}, True),
        ({"lift": "cos(theta)"}, True),
        ({}, False),
        ({"lift": 3}, False),
        ({"lift": "cos(theta)", "file": "a.csv"}, False),
        ({"file": 3}, False),
        (ROWS | {"file": "a.csv"}, False),
        (ROWS | {"lift_deg": ROWS["lift_mm"]}, False),
        (ROWS | {"lift_mm": ROWS["lift_mm"][:5]}, False),
        (ROWS | {"lift_mm": 3}, False),
        (ROWS | {"theta_deg": [*ROWS["theta_deg"][:5], 721]}, False),
        (ROWS | {"smoothing_tolerance_mm": 0}, False),
        (ROWS | {"smoothing": 1}, False),
        ({"theta_deg": ROWS["theta_deg"]}, False),
        ({"lift_mm": ROWS["lift_mm"]}, False),
    ],
)
def test_both_judge_a_motion_of_the_whole_turn_alike(motion: dict[str, Any], good: bool) -> None:
    document = _edited([(("motion",), motion)], CAM)
    assert (not examine(document).faults) is good
    assert SHARED.is_valid(document) is good


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("output", "files"), ["csv", "csv"]),
        (("output", "files"), ["csv", "x"]),
        (("output", "chord_tolerance_mm"), 0),
        (("pair", "module_mm"), 2),
        (("pair", "center_distance_mm"), None),
        (("pair", "teeth"), [36]),
        (("pair", "teeth"), [36, 2]),
        (("law", "knots_deg"), [0]),
        (("law", "ratios"), [1, 0, 1]),
        (("law", "shape"), "line"),
        (("law", "type"), None),
        (("law",), None),
        (("blank", "bore_diameter_mm"), [20]),
        (("blank", "bore_diameter_mm"), "20"),
        (("blank", "bolts"), 2.5),
        (("no_such_table",), {}),
        (("kind",), "cam"),
    ],
)
def test_both_refuse(place: tuple[str, ...], value: Any) -> None:
    document = _edited([(place, value)])
    assert examine(document).faults
    assert not SHARED.is_valid(document)


def _whole_numbers_apart(value: Any) -> Any:
    """JSON schema takes 36.0 for a whole number, TOML does not: give it another value there."""
    if isinstance(value, dict):
        return {
            key: [0.5 if isinstance(x, float) else x for x in item]
            if key == "teeth" and isinstance(item, list)
            else _whole_numbers_apart(item)
            for key, item in value.items()
        }
    return value


SHARED = jsonschema.Draft202012Validator(schema())


def test_the_comparison_notices_a_schema_that_is_too_lenient() -> None:
    lenient = schema()
    del lenient["$defs"]["gear-pair-rack"]["properties"]["addendum"]["maximum"]
    document = _edited([(("rack", "addendum"), 400)])
    assert examine(document).faults
    assert not list(jsonschema.Draft202012Validator(lenient).iter_errors(document))
    assert list(SHARED.iter_errors(document))


def test_names_that_both_can_judge_are_judged_alike() -> None:
    for name, good in (("a", True), ("räder", True), ("a b", False), ("x.", False), ("-x", False)):
        assert SHARED.is_valid(GOOD | {"name": name}) == good
        assert (not examine(GOOD | {"name": name}).faults) == good


def test_good_is_good() -> None:
    resting = _edited([(("motion", 3, "angle_deg"), "rest")], CAM)
    for good in (GOOD, CAM, resting):
        assert not list(SHARED.iter_errors(good))
        assert not examine(good).faults
