"""What users can name has an example in its docstring that does what it shows."""

from __future__ import annotations

import inspect
import pydoc
from collections.abc import Iterator

import matplotlib.pyplot as plt
import pytest

import gearcam as gc
from gearcam.base.registry import Registry
from gearcam.base.user_names import ForUsers
from gearcam.laws.entry import SOURCES, LawEntry
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS
from helpers_examples import faults, lines_of, room

LINES = range(2, 12)
"""How long an example may be, answers left out."""

HOMES = {"gc": gc, "gc.laws": gc.laws, "gc.motion_laws": gc.motion_laws}
NAMES = [
    f"{home}.{name}" for home, one in HOMES.items() for name in dir(one) if name != "__version__"
]

RESULTS: list[type] = [
    one
    for one in (getattr(gc, name) for name in dir(gc))
    if inspect.isclass(one) and issubclass(one, gc.Result | gc.StudyResult) and one is not gc.Result
]


def named(owner: type) -> list[str]:
    return [name for name in dir(owner) if not name.startswith("_")]


OWN = {
    f"{home.__qualname__}.{name}": vars(home)[name]
    for owner in RESULTS
    for name in named(owner)
    if name != "design"  # told of by the class
    for home in [next(one for one in owner.__mro__ if name in vars(one))]
}
"""Attributes and methods that results list, those of one class once."""


@pytest.fixture(scope="module", autouse=True)
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    plt.switch_backend("agg")
    with room(tmp_path_factory.mktemp("examples")):
        yield
    plt.close("all")


@pytest.mark.parametrize("name", NAMES)
def test_an_example_does_what_it_shows(name: str) -> None:
    home, _, word = name.rpartition(".")
    what = getattr(HOMES[home], word)
    assert "Examples\n" in what.__doc__
    lines = lines_of(what.__doc__)
    assert len(lines) in LINES
    assert name in "\n".join(lines) or any("gc.load" in line for line in lines)
    assert faults(what.__doc__) == ""


@pytest.mark.parametrize("name", HOMES)
def test_what_help_says_of_a_module_runs(name: str) -> None:
    doc = HOMES[name].__doc__ or ""
    assert len(lines_of(doc)) > 1
    assert faults(doc) == ""


@pytest.mark.parametrize("name", OWN)
def test_each_name_that_a_result_lists_has_an_example(name: str) -> None:
    doc, _, _ = (inspect.getdoc(OWN[name]) or "").partition("\nStudies\n-------\n")
    assert "Examples\n" in doc  # those of each study are run by `test_studies.py`
    assert len(lines_of(doc)) in LINES
    assert name.rpartition(".")[2] in "\n".join(lines_of(doc))
    assert faults(doc) == ""


@pytest.mark.parametrize("owner", RESULTS)
def test_a_result_lists_what_has_an_example_and_nothing_else(owner: type) -> None:
    every = {name for home in owner.__mro__ for name in vars(home) if not name.startswith("_")}
    shown = {name for name in every if "Examples\n" in (inspect.getdoc(getattr(owner, name)) or "")}
    assert {*named(owner)} - {"design"} == shown
    assert len(shown) < 35


def test_what_is_listed_is_there_and_help_tells_nothing_else() -> None:
    result = gc.build(gc.load("profiles/ellipse.toml"))
    assert [name for name in dir(result) if not name.startswith("_")] == named(type(result))
    assert "__init__" in dir(result)
    assert "_repr_html_" in dir(result)
    assert result.design.name == "ellipse"
    assert result.kind.name == "gear-pair"  # not listed, and works
    told = pydoc.plain(pydoc.render_doc(result))
    assert "contact_ratios" in told
    assert "parts_subject" not in told


def test_a_design_lists_its_tables_and_what_it_can_do() -> None:
    design = gc.load("profiles/ellipse.toml")
    names = [name for name in dir(design) if not name.startswith("_")]
    assert {"law", "pair", "rack", "kind", "to_dict", "with_"} <= {*names}
    assert {"added", "examined", "asked"}.isdisjoint(names)
    for name in ("to_dict", "with_"):
        doc = inspect.getdoc(getattr(design, name)) or ""
        assert "Examples\n" in doc
        assert faults(doc) == ""


@pytest.mark.parametrize("laws", [LAWS, MOTION_LAWS], ids=["ratio", "motion"])
def test_help_of_a_law_tells_its_source(laws: Registry[LawEntry]) -> None:
    home = gc.laws if laws is LAWS else gc.motion_laws
    for entry in laws.values():
        doc = getattr(home, entry.parameters.__name__).__doc__
        _, _, tail = doc.partition("\n\nReferences\n----------\n")
        told, _, _ = tail.partition("\n\nExamples\n")
        citation, *titles = told.splitlines()
        assert citation == entry.source
        assert titles == [text for name, text in SOURCES.items() if name in entry.source]


def test_a_class_without_a_list_shows_all() -> None:
    class Sample(ForUsers):
        size = 3

    class Listing(Sample):
        for_users = ("weight",)
        weight = 1

    assert "size" in dir(Sample())
    assert [name for name in dir(Listing()) if not name.startswith("_")] == ["weight"]


def test_a_wrong_answer_is_seen() -> None:
    told = faults("Add.\n\n>>> 1 + 1\n3\n")
    assert "Expected:\n    3\nGot:\n    2\n" in told
