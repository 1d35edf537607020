"""What is set for all tests."""

from __future__ import annotations

import gc

gc.disable()  # until the tests are collected, which all stay


def pytest_collection_finish() -> None:
    """Leave the tests that were collected out of each collection of garbage."""
    gc.collect()
    gc.freeze()
    gc.enable()
