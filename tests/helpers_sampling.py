"""Which cases run each time: a few of many, and random ones, the same in every run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st

QUICK = settings(
    derandomize=True,
    database=None,
    deadline=None,
    max_examples=10,
    phases=[Phase.generate, Phase.shrink],
    suppress_health_check=[
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
        HealthCheck.filter_too_much,
    ],
)
"""Few random cases, the same ones in every run."""


def few(cases: Iterable[Any], every: int = 2) -> list[Any]:
    """Parameters of a test: the first and each `every`-th after it are run each time."""
    given = (case if isinstance(case, tuple) else (case,) for case in cases)
    return [
        pytest.param(*case, marks=() if number % every == 0 else pytest.mark.slow)
        for number, case in enumerate(given)
    ]


def chosen(cases: Iterable[Any] | Mapping[str, Any], *names: Any) -> list[Any]:
    """Parameters of a test: those that are named are run each time, the others are slow.

    A mapping gives its values, which its keys name; other cases name themselves.
    """
    values = dict(cases) if isinstance(cases, Mapping) else {}
    given = list(cases)
    assert all(name in given for name in names), names
    found = []
    for case in given:
        marks = () if case in names else pytest.mark.slow
        if values:
            found.append(pytest.param(values[case], id=case, marks=marks))
        else:
            found.append(pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=marks))
    return found


def rounded(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of at most three decimals, as people type them."""
    return st.integers(round(low * 1000), round(high * 1000)).map(lambda n: n / 1000)
