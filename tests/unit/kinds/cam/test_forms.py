"""Each form of cams takes the keys of its own tables: reader, schema and Python agree."""

from __future__ import annotations

import copy
import tomllib
from typing import Any

import jsonschema
import pytest

import gearcam
from gearcam.designs.examine import examine
from gearcam.designs.kind import KINDS
from gearcam.designs.schema import schema
from gearcam.kinds.cam.forms.base import FORMS as REGISTRY
from helpers_pairs import PROFILES
from helpers_sampling import few


def profiles() -> dict[str, dict[str, Any]]:
    """Return the document of the first profile of each form."""
    found: dict[str, dict[str, Any]] = {}
    for path in sorted(PROFILES.glob("*.toml")):
        document = tomllib.loads(path.read_text("utf-8"))
        if document["kind"] == "cam" and isinstance(document.get("motion"), list):
            found.setdefault(document["cam"].get("form", "disc"), document)
    return {form: found[form] for form in REGISTRY}


FORMS = profiles()
TABLES = ("follower", "cam", "blank", "output")
KEYS = [
    (title, key)
    for title in TABLES
    for key in KINDS["cam"].table(title).entries
    if (title, key) != ("cam", "form")
]
VALIDATOR = jsonschema.Draft202012Validator(schema())
MOTION = gearcam.MotionFormula(lift="5*(1 - cos(theta))")


def with_key(form: str, title: str, key: str, value: Any) -> dict[str, Any]:
    """Return a document of a form with another key."""
    document = copy.deepcopy(FORMS[form])
    document.setdefault(title, {})[key] = value
    return document


def unlike_default(title: str, key: str) -> Any:
    """Return a valid value of a key that is not its default."""
    entry = KINDS["cam"].table(title).entries[key]
    if entry.base is bool:
        return not entry.default
    if entry.param.choices:
        values = [one for one in entry.param.choices if one != entry.default]
        return values[:1] if entry.length is not None else values[0]
    return entry.param.example or (2 if entry.base is int else 1.25)


def foreign(document: dict[str, Any]) -> dict[tuple[Any, ...], str]:
    """Return what is allowed for each key that does not apply to the form of a document."""
    faults = examine(document, stem="x").faults
    return {fault.path: fault.allowed for fault in faults if "does not apply to a" in fault.message
            and "with cam.form = " in fault.allowed}  # fmt: skip


@pytest.mark.parametrize(("title", "key"), KEYS, ids=lambda one: one)
def test_a_key_is_refused_with_the_names_of_the_forms_that_take_it(title: str, key: str) -> None:
    value = unlike_default(title, key)
    allowed = {form: foreign(with_key(form, title, key, value)) for form in FORMS}
    takes = [form for form in FORMS if (title, key) not in allowed[form]]
    assert takes
    for form in set(FORMS) - set(takes):
        words = allowed[form][title, key].rpartition("with cam.form = ")[2]
        named = [word.strip('"') for word in words.replace(" or ", ", ").split(", ")]
        assert [word for word in named if word in FORMS] == takes
        assert {*named} - {*takes} <= {"cylinder", "globoidal"}


@pytest.mark.parametrize("form", few(FORMS))
def test_the_schema_refuses_keys_of_other_forms_too(form: str) -> None:
    assert VALIDATOR.is_valid(FORMS[form])
    refused = []
    for title, key in KEYS:
        document = with_key(form, title, key, unlike_default(title, key))
        if (title, key) in foreign(document):
            refused.append(key)
            assert not VALIDATOR.is_valid(document), (title, key)
    assert refused


@pytest.mark.parametrize("form", [form for form in FORMS if form != "disc"])
def test_defaults_of_other_forms_change_nothing(form: str) -> None:
    """So a design of one form can be changed to another with `Design.with_`."""
    document, plain = copy.deepcopy(FORMS[form]), examine(FORMS[form], stem="x").parts
    for title in TABLES:
        known = KINDS["cam"].table_in({}, title).entries
        for key, entry in known.items():
            if entry.default is None or entry.required or key == "form":
                continue
            document.setdefault(title, {}).setdefault(key, entry.outward(entry.default))
    found = examine(document, stem="x")
    assert not found.faults
    assert found.parts == plain


def test_tables_of_a_disc_are_taken_for_those_of_another_form() -> None:
    follower = gearcam.FollowerSpec(type="roller", roller_radius=6.0)
    size = gearcam.GrooveSpec(prime_radius=40.0, outer_diameter=130.0, groove_depth=6.0)
    design = gearcam.CamDesign(name="groove", motion=MOTION, follower=follower, cam=size)
    assert design.follower == gearcam.GrooveFollower(type="roller", roller_radius=6.0)
    assert design.form == "groove"
    assert design == gearcam.design(design.to_dict())


def test_what_another_form_does_not_have_is_refused_in_python() -> None:
    follower = gearcam.FollowerSpec(type="roller", roller_radius=6.0, offset=3.0)
    with pytest.raises(gearcam.DesignError, match="offset: does not apply to a yoke"):
        gearcam.CamDesign(
            name="yoke", motion=MOTION, follower=follower, cam=gearcam.YokeSpec(prime_radius=40.0)
        )
    groove = gearcam.GrooveFollower(type="roller", roller_radius=6.0, roller2_radius=5.0)
    with pytest.raises(gearcam.DesignError, match=r"roller2.*not apply to a disc"):
        gearcam.CamDesign(
            name="disc", motion=MOTION, follower=groove, cam=gearcam.CamSpec(prime_radius=40.0)
        )
