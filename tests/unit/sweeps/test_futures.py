"""The engine of an executor: whatever submits functions and returns futures."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

import pytest

import gearcam as gc
from gearcam.sweeps import tasks
from gearcam.sweeps.futures import Futures
from gearcam.sweeps.rows import Built
from helpers_sweep import BASE, odd


class Future:
    """No more of a future than what the documentation of dask and of Python has in common."""

    def __init__(self) -> None:
        self.cancelled = False
        self._told: list[Callable[[Any], Any]] = []
        self._answer: tuple[Any, BaseException | None] | None = None

    def add_done_callback(self, told: Callable[[Any], Any]) -> None:
        self._told.append(told)
        if self._answer is not None:
            told(self)

    def result(self) -> Any:
        assert self._answer is not None
        value, error = self._answer
        if error is not None:
            raise error
        return value

    def cancel(self) -> None:
        self.cancelled = True

    def take(self, value: Any, error: BaseException | None = None) -> None:
        self._answer = value, error
        for told in self._told:
            told(self)


class Client:
    """A client whose only worker is a thread, which answers in another order."""

    def __init__(self) -> None:
        self.sent: list[tuple[Future, Callable[[], Any]]] = []
        self.futures: list[Future] = []
        self._more = threading.Condition()
        self._ended = False
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future:
        future = Future()
        with self._more:
            self.sent.append((future, lambda: function(*arguments)))
            self.futures.append(future)
            self._more.notify()
        return future

    def _work(self) -> None:
        while True:
            with self._more:
                self._more.wait_for(lambda: self.sent or self._ended)
                if self._ended:
                    return
                future, call = self.sent.pop()  # the last one first
            if future.cancelled:
                continue
            try:
                future.take(call())
            except Exception as error:
                future.take(None, error)

    def close(self) -> None:
        with self._more:
            self._ended = True
            self._more.notify()
        self._thread.join()


@contextmanager
def client() -> Iterator[Client]:
    made = Client()
    try:
        yield made
    finally:
        made.close()


def rows(executor: Any, *deeds: str) -> list[Built]:
    jobs = [(number, {"deed": deed}) for number, deed in enumerate(deeds)]
    found = list(Futures(executor=executor, measure=odd, seconds=2.0).run(BASE, jobs))
    return sorted(found, key=lambda row: row.number)


def test_a_client_of_the_documented_interface_is_enough() -> None:
    keys = {"law.eccentricity": [0.1, 0.3, 0.99], "pair.teeth": [[20, 20]]}
    here = gc.sweep(BASE, keys, jobs=1).columns
    with client() as one:
        sweep = gc.sweep(BASE, keys, client=one)
        there = sweep.columns
    assert sweep.engine.name == "the Client given"
    for name in set(here) - {"time_s"}:
        assert there[name].tolist() == pytest.approx(here[name].tolist(), nan_ok=True), name


def test_every_row_comes_once_and_a_variant_that_hangs_costs_only_itself() -> None:
    with client() as one:
        found = rows(one, "work", "die", "hang", *["work"] * 90)
    assert [row.number for row in found] == list(range(93))
    assert [row.number for row in found if not row.made] == [1, 2]
    assert "longer than 2 s" in found[2].refusal


def test_an_end_cancels_what_is_not_built() -> None:
    with client() as one:
        engine = Futures(executor=one, measure=odd)
        with engine.session(BASE) as build:
            lot = build([(k, {"deed": "nap"}) for k in range(30)])
            next(lot)
        assert any(future.cancelled for future in one.futures)
    assert not tasks._crews


@pytest.mark.slow
def test_executors_of_python_build() -> None:
    for executor in (ThreadPoolExecutor(2), ProcessPoolExecutor(2)):
        with executor:
            found = rows(executor, *["work"] * 12)
            assert [row.number for row in found] == list(range(12))


def test_an_executor_that_has_ended_is_told() -> None:
    executor = ThreadPoolExecutor(1)
    executor.shutdown()
    with pytest.raises(gc.DesignError, match="a task of the executor failed"):
        rows(executor, "work")


def test_a_task_that_fails_is_told() -> None:
    class Failing:
        def submit(self, *_: Any) -> Future:
            future = Future()
            future.take(None, ValueError("no worker\nis left"))
            return future

    with pytest.raises(gc.DesignError, match="ValueError: no worker is left"):
        rows(Failing(), "work")


def test_a_search_asks_the_same_executor_lot_by_lot() -> None:
    words: dict[str, Any] = {"minimize": "pair.ratio.max", "method": "random", "trials": 30}
    keys = {"law.eccentricity": "0.1:0.4", "output.files": [["csv"]]}
    with client() as one:
        found = gc.optimize(BASE, keys, client=one, **words)
        assert len(one.futures) >= 30
    assert len(found.rows) == 30
    assert found.best[0].facts["pair.ratio.max"] == found.columns["pair.ratio.max"].min()
