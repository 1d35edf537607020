"""The schema of design files and the reader agree, judged by another implementation of schemas."""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcam.design import load, loads
from gearcam.design.reader import examine
from gearcam.design.schema import schema
from gearcam.design.tables import TABLES, law_table, table
from gearcam.design.template import template
from gearcam.laws.base import LAWS

PROFILES = sorted((Path(__file__).parents[2] / "profiles").glob("*.toml"))
GOOD: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "good",
    "law": {"type": "phases", "knots_deg": [0, 160, 360], "ratios": [1.6, "solve", 1.6]},
    "pair": {"center_distance_mm": 180, "teeth": [36, 36], "face_width_mm": 10},
    "rack": {"pressure_angle_deg": 20, "addendum": 1, "dedendum": 1.25, "tip_radius": 0.3},
    "blank": {"bore_diameter_mm": [20, 20]},
    "output": {"files": ["csv"], "chord_tolerance_mm": 0.01, "dxf_curves": "lines"},
}


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    made = schema()
    jsonschema.Draft202012Validator.check_schema(made)
    return jsonschema.Draft202012Validator(made)


@pytest.mark.parametrize("path", PROFILES, ids=lambda path: path.stem)
def test_every_profile_is_valid(validator: jsonschema.Draft202012Validator, path: Path) -> None:
    validator.validate(tomllib.loads(path.read_text("utf-8")))
    load(path)


def test_the_template_is_valid(validator: jsonschema.Draft202012Validator) -> None:
    validator.validate(tomllib.loads(template()))


def test_every_key_is_described_and_no_other_is_allowed(
    validator: jsonschema.Draft202012Validator,
) -> None:
    definitions = validator.schema["$defs"]  # type: ignore[index]
    expected = {title: set(table(title).entries) for title in [*TABLES, "limits"]}
    expected |= {f"law-{name}": {"type", *law_table(name).entries} for name in LAWS}
    assert {name: set(made["properties"]) for name, made in definitions.items()} == expected
    for name, made in definitions.items():
        assert made["additionalProperties"] is False
        for key, rule in made["properties"].items():
            assert key == "type" or rule["description"], f"{name}.{key}"


@pytest.mark.parametrize("name", list(LAWS))
def test_every_law_has_a_branch_that_takes_its_examples(
    validator: jsonschema.Draft202012Validator, name: str
) -> None:
    for claim in LAWS[name].claims():
        values = vars(claim.parameters)
        law = {"type": name} | law_table(name).outward(values)
        validator.validate(GOOD | {"law": law})
        assert not list(validator.iter_errors(GOOD | {"law": law}))
        assert list(validator.iter_errors(GOOD | {"law": law | {"no_such_key": 1}}))


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


def _edited(edits: list[tuple[tuple[str, ...], Any]]) -> dict[str, Any]:
    document = {key: dict(v) if isinstance(v, dict) else v for key, v in GOOD.items()}
    for place, value in edits:
        target: Any = document if len(place) == 1 else document.get(place[0])
        if isinstance(target, dict):
            if value is None:
                target.pop(place[-1], None)
            else:
                target[place[-1]] = copy.deepcopy(value)
    return document


# what a schema cannot know: relations between values, and numbers that only TOML tells apart
BEYOND = ("ratios for", "knots must", "first knot", "last ratio", "more than one", "too coarse")


@given(st.lists(st.tuples(PLACES, VALUES | st.none()), min_size=1, max_size=3))
@settings(max_examples=400)
def test_reader_and_schema_refuse_the_same_files(edits: list[tuple[tuple[str, ...], Any]]) -> None:
    document = _edited(edits)
    faults = examine(document, stem="file").faults
    told = [fault for fault in faults if not any(words in fault.message for words in BEYOND)]
    errors = list(SHARED.iter_errors(_whole_numbers_apart(document)))
    assert bool(told) == bool(errors), (document, told, errors)


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
    del lenient["$defs"]["rack"]["properties"]["addendum"]["maximum"]
    document = _edited([(("rack", "addendum"), 400)])
    assert examine(document).faults
    assert not list(jsonschema.Draft202012Validator(lenient).iter_errors(document))
    assert list(SHARED.iter_errors(document))


def test_names_that_both_can_judge_are_judged_alike() -> None:
    for name, good in (("a", True), ("räder", True), ("a b", False), ("x.", False), ("-x", False)):
        assert SHARED.is_valid(GOOD | {"name": name}) == good
        assert (not examine(GOOD | {"name": name}).faults) == good


def test_good_is_good() -> None:
    assert not list(SHARED.iter_errors(GOOD))
    assert not examine(GOOD).faults
    assert loads(template()).name
