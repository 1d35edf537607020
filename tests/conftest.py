"""What is set for all tests."""

from __future__ import annotations

import gc


def pytest_collection_finish() -> None:
    """Leave the tests that were collected out of each collection of garbage: they all stay."""
    gc.collect()
    gc.freeze()
