"""Examples in docstrings: what is wrong with them when they run."""

from __future__ import annotations

import doctest
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import gearcam as gc
from arch import rules


def example_of(doc: str, name: str = "example") -> doctest.DocTest:
    return doctest.DocTestParser().get_doctest(doc, {}, name, None, None)


def lines_of(doc: str) -> list[str]:
    """What a user types, without the answers."""
    return "".join(step.source for step in example_of(doc).examples).splitlines()


def faults(doc: str, name: str = "example") -> str:
    """What an example answers other than it shows; empty if all is as shown."""
    told: list[str] = []
    doctest.DocTestRunner(verbose=False).run(example_of(doc, name), out=told.append)
    return "".join(told)


@contextmanager
def room(folder: Path) -> Iterator[None]:
    """Work in a folder with the profiles beside it; equal designs are built once."""
    profiles = folder / "profiles"
    if not profiles.exists():
        profiles.symlink_to(rules.ROOT / "profiles")
    build: Any = gc.build
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(gc, "build", cache(build))
        yield
