"""Processes that build variants: each row once, whatever becomes of a process."""

from __future__ import annotations

import importlib
import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError
from gearcam.sweeps.pool import Processes
from gearcam.sweeps.rows import Built, measured
from helpers_processes import ENVIRONMENT
from helpers_sweep import BASE, Loads, odd


def deeds(*words: str) -> list[tuple[int, dict[str, Any]]]:
    return [(number, {"deed": word}) for number, word in enumerate(words)]


def rows(wanted: Sequence[tuple[int, dict[str, Any]]], **settings: Any) -> dict[int, Built]:
    found: dict[int, Built] = {}
    for row in Processes(**{"jobs": 2, "measure": odd} | settings).run(BASE, iter(wanted)):
        assert row.number not in found
        found[row.number] = row
    assert sorted(found) == [number for number, _ in wanted]
    return found


def test_each_variant_has_one_row_with_its_values() -> None:
    jobs = deeds(*["work"] * 40, "print")
    found = rows(jobs)
    assert all(found[number].values == values for number, values in jobs)
    assert len({row.facts["pid"] for row in found.values()}) == 2


def test_a_variant_that_ends_its_process_once_is_built_once_more(tmp_path: Path) -> None:
    found = rows(deeds("work", f"die {tmp_path / 'once'}", "work"), jobs=1)
    assert not any(row.refusal for row in found.values())


@pytest.mark.slow
def test_a_variant_that_ends_its_process_twice_costs_only_itself() -> None:
    found = rows(deeds("work", "die", "work", "work", "die"))
    assert [bool(found[k].refusal) for k in range(5)] == [False, True, False, False, True]
    assert "ended twice" in found[1].refusal


def test_a_variant_that_hangs_costs_only_itself() -> None:
    found = rows(deeds("work", "hang", "work", "work"), seconds=1.0)
    assert [bool(found[k].refusal) for k in range(4)] == [False, True, False, False]
    assert found[1].refusal == "it takes longer than 1 s"


def test_a_variant_that_eats_memory_costs_only_itself() -> None:
    found = rows(deeds("work", "eat", "work"), memory=2 << 30)
    assert [bool(found[k].refusal) for k in range(3)] == [False, True, False]


@pytest.mark.slow
def test_a_process_that_is_killed_from_outside_costs_nothing() -> None:
    jobs = ((number, {"deed": "work"}) for number in range(400))
    found: list[int] = []
    killed = 0
    for row in Processes(jobs=2, measure=odd).run(BASE, jobs):
        found.append(row.number)
        if len(found) in (50, 150):
            os.kill(int(row.facts["pid"]), signal.SIGKILL)
            killed += 1
    assert killed == 2
    assert sorted(found) == list(range(400))


def children() -> list[str]:
    """Processes of this one, without that which tracks what processes share."""
    threads = Path("/proc/self/task").glob("*/children")
    found = [Path("/proc", word) for one in threads for word in one.read_text().split()]
    return [one.name for one in found if b"resource_tracker" not in (one / "cmdline").read_bytes()]


def test_no_process_is_left_when_the_rows_are_not_wanted_any_more() -> None:
    before = set(children())
    running = Processes(jobs=2, measure=odd).run(BASE, iter(deeds("work", *["hang"] * 3)))
    next(running)
    assert set(children()) > before
    running.close()  # type: ignore[attr-defined]
    assert set(children()) == before


PARENT = """
from gearcam.sweeps.pool import Processes
from helpers_sweep import BASE, odd

jobs = [(number, {"deed": deed}) for number, deed in enumerate(("work", "hang"))]
for row in Processes(jobs=1, measure=odd).run(BASE, jobs):
    print(row.number, flush=True)
"""


def test_a_process_that_hangs_ends_with_a_parent_that_is_killed() -> None:
    paths = os.pathsep.join(sys.path)
    running = subprocess.Popen(
        [sys.executable, "-c", PARENT],
        env=ENVIRONMENT | {"PYTHONPATH": paths},
        stdout=-1,
        stderr=-1,
    )
    assert running.stdout
    assert running.stdout.readline() == b"0\n"  # the next one has begun
    running.kill()
    assert running.communicate(timeout=20) == (b"", b"")  # nobody has these streams any more


def test_jobs_are_read_as_they_are_needed() -> None:
    read = 0

    def jobs() -> Iterator[tuple[int, dict[str, Any]]]:
        nonlocal read
        for number in range(100_000):
            read += 1
            yield number, {"deed": "work"}

    running = Processes(jobs=1, measure=odd).run(BASE, jobs())
    next(running)
    running.close()  # type: ignore[attr-defined]
    assert read < 5000


def test_an_error_in_the_jobs_is_raised() -> None:
    def jobs() -> Iterator[tuple[int, dict[str, Any]]]:
        yield 0, {"deed": "work"}
        raise ValueError("no more")

    with pytest.raises(ValueError, match="no more"):
        list(Processes(jobs=2, measure=odd).run(BASE, jobs()))


def test_rows_of_processes_are_those_of_this_one() -> None:
    jobs = [(k, {"law.eccentricity": 0.1 * k, "pair.teeth": [24, 24]}) for k in range(4)]
    jobs.append((4, {"law.eccentricity": 2.0}))
    rows = {row.number: row for row in Processes(jobs=2).run(BASE, iter(jobs))}
    for number, values in jobs:
        here = replace(measured(BASE, number, values), time_s=0.0)
        assert replace(rows[number], time_s=0.0) == here
    assert rows[3].facts == gc.build(BASE.with_(jobs[3][1])).record()
    assert "law.eccentricity" in rows[4].refusal


@pytest.mark.parametrize(
    ("loads", "why"),
    [
        (Loads(importlib.import_module, "gearcam_gone"), "begin: ModuleNotFoundError: .*gone"),
        (Loads(os._exit, 1), r"begin\n.*allowed: a script"),
    ],
)
def test_a_process_that_cannot_begin_is_a_fault_and_not_a_refusal(loads: Loads, why: str) -> None:
    with (
        Processes(jobs=2, measure=loads).session(BASE) as build,
        pytest.raises(DesignError, match=why),
    ):
        list(build(deeds("work")))


def test_lots_of_a_session_are_built_by_the_same_processes() -> None:
    with Processes(jobs=1, measure=odd).session(BASE) as build:
        lots = [list(build(deeds("work", "work"))) for _ in range(3)]
    assert len({row.facts["pid"] for rows in lots for row in rows}) == 1
