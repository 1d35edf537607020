"""Workers of the live view that are killed."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor

import pytest

from gearcam.view.workers import Workers


@pytest.fixture
def workers() -> Iterator[Workers]:
    made = Workers()
    yield made
    made.end()


def test_what_a_killed_worker_did_is_done_by_another(workers: Workers) -> None:
    """The others end with it, also those that wait; all is done once more."""
    first = workers.submit(os.getpid).result(60)
    waiting = [workers.submit(time.sleep, 0.2) for _ in range(workers.count + 1)]
    os.kill(first, signal.SIGKILL)
    assert [one.result(60) for one in waiting] == [None] * len(waiting)
    assert workers.submit(os.getpid).result(60) != first
    with pytest.raises(BrokenExecutor):  # one that kills each of them is not tried for ever
        workers.submit(os._exit, 1).result(60)
    assert workers.submit(divmod, 7, 2).result(60) == (3, 1)
    with pytest.raises(ZeroDivisionError):
        workers.submit(divmod, 7, 0).result(60)
