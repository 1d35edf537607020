"""Cases of which a few run each time, and all of them among the slow tests."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def few(cases: Iterable[Any], every: int = 2) -> list[Any]:
    """Parameters of a test: the first and each `every`-th after it are run each time."""
    given = (case if isinstance(case, tuple) else (case,) for case in cases)
    return [
        pytest.param(*case, marks=() if number % every == 0 else pytest.mark.slow)
        for number, case in enumerate(given)
    ]
