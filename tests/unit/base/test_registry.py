"""Registries load an entry when it is asked for, and no other."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from gearcam.base.registry import Registry, lazy_names
from gearcam.kinds.cam.forms.base import FORMS
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS

HOME = """
from registry_of_sizes import Size
ENTRIES = (Size(name="{0}"), Size(name="{0}er"))
"""


HOMES = ("sizes.small", "sizes.tall")


@dataclass(frozen=True)
class Size:
    """Something with a name."""

    name: str


@pytest.fixture
def sizes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Registry[Size]]:
    module = type(sys)("registry_of_sizes")
    module.Size = Size  # pyright: ignore[reportAttributeAccessIssue]
    monkeypatch.setitem(sys.modules, "registry_of_sizes", module)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "sizes").mkdir()
    for name in ("small", "tall"):
        (tmp_path / "sizes" / f"{name}.py").write_text(HOME.format(name))
    yield Registry("size", "sizes", {"small": ("small", "smaller"), "tall": ("tall", "taller")})
    for name in ("sizes", *HOMES):
        sys.modules.pop(name, None)


def test_names_are_known_before_anything_is_loaded(sizes: Registry[Size]) -> None:
    assert list(sizes) == ["small", "smaller", "tall", "taller"]
    assert len(sizes) == 4
    assert "taller" in sizes
    assert "huge" not in sizes
    assert not set(HOMES) & set(sys.modules)


def test_an_entry_loads_its_home_only(sizes: Registry[Size]) -> None:
    assert sizes["taller"] == Size("taller")
    assert sizes["tall"] == Size("tall")
    assert HOMES[0] not in sys.modules
    assert [size.name for size in sizes.values()] == list(sizes)


def test_unknown_names_are_key_errors(sizes: Registry[Size]) -> None:
    assert sizes.get("huge") is None
    with pytest.raises(KeyError, match="huge"):
        sizes["huge"]


@pytest.mark.parametrize("registry", [LAWS, MOTION_LAWS, FORMS], ids=repr)
def test_each_module_has_the_entries_that_its_name_promises(registry: Registry[Any]) -> None:
    for name, entry in registry.items():
        assert entry.name == name
    homes = set(registry._homes.values())
    named = [one.name for home in homes for one in importlib.import_module(home).ENTRIES]
    assert sorted(named) == sorted(registry)


def test_parameters_name_their_law() -> None:
    for registry in (LAWS, MOTION_LAWS):
        for name, entry in registry.items():
            assert registry.name_of(entry.example) == name
    assert LAWS.name_of(Size("tall")) == ""


def test_names_of_a_package_load_what_they_need() -> None:
    """Others than those of classes do not load the classes."""
    loaded: list[str] = []

    def classes() -> dict[str, type]:
        loaded.append("classes")
        return {"Size": Size}

    find, names = lazy_names("there is no size", classes, {"json": ("json", "loads")})
    assert find("json") is json
    assert find("loads") is json.loads
    for wrong in ("_repr_html_", "size"):
        with pytest.raises(AttributeError, match=f"there is no size {wrong};"):
            find(wrong)
    assert loaded == []
    assert find("Size") is Size
    assert names() == find("__all__") == ["Size", "json", "loads"]
    with pytest.raises(AttributeError, match="there is no size Sise;"):
        find("Sise")
