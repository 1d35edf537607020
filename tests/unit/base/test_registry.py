"""Registries load an entry when it is asked for, and no other."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from gearcam.base.registry import Registry, lazy_names

HOME = """
from registry_of_sizes import SIZES, Size
SIZES.register(Size(name="{0}"))
SIZES.register(Size(name="{0}er"))
"""


@dataclass(frozen=True)
class Size:
    """Something with a name."""

    name: str


@pytest.fixture
def sizes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Registry[Size]]:
    made: Registry[Size] = Registry(
        "size", {"home_of_small": ("small", "smaller"), "home_of_tall": ("tall", "taller")}
    )
    module = type(sys)("registry_of_sizes")
    module.SIZES, module.Size = made, Size  # pyright: ignore[reportAttributeAccessIssue]
    monkeypatch.setitem(sys.modules, "registry_of_sizes", module)
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("small", "tall"):
        (tmp_path / f"home_of_{name}.py").write_text(HOME.format(name))
        monkeypatch.delitem(sys.modules, f"home_of_{name}", raising=False)
    yield made
    for name in ("small", "tall"):
        sys.modules.pop(f"home_of_{name}", None)


def test_names_are_known_before_anything_is_loaded(sizes: Registry[Size]) -> None:
    assert list(sizes) == ["small", "smaller", "tall", "taller"]
    assert len(sizes) == 4
    assert "taller" in sizes
    assert "huge" not in sizes
    assert not {"home_of_small", "home_of_tall"} & set(sys.modules)


def test_an_entry_loads_its_home_only(sizes: Registry[Size]) -> None:
    assert sizes["taller"] == Size("taller")
    assert sizes["tall"] == Size("tall")
    assert "home_of_small" not in sys.modules
    assert [size.name for size in sizes.values()] == list(sizes)


def test_unknown_names_are_key_errors(sizes: Registry[Size]) -> None:
    assert sizes.get("huge") is None
    with pytest.raises(KeyError, match="huge"):
        sizes["huge"]
    sizes.register(Size("huge"))  # one without a home
    assert sizes["huge"] == Size("huge")
    assert list(sizes)[-1] == "huge"
    assert len(sizes) == 5


def test_a_name_is_given_once(sizes: Registry[Size]) -> None:
    first = sizes["small"]
    with pytest.raises(ValueError, match="size 'small' is registered twice"):
        sizes.register(Size("small"))
    assert sizes["small"] is first


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
