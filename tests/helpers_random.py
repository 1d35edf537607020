"""How designs at random are drawn: the same ones in every run."""

from __future__ import annotations

from hypothesis import HealthCheck, Phase, settings

QUICK = settings(
    derandomize=True,
    database=None,
    deadline=None,
    max_examples=20,
    phases=[Phase.generate, Phase.shrink],
    suppress_health_check=[
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
        HealthCheck.filter_too_much,
    ],
)
