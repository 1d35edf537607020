"""The engine of a cluster: rows as by processes of this machine, whatever becomes of workers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import pytest

import gearcam as gc
from gearcam.sweep import cluster
from gearcam.sweep.cluster import Cluster
from gearcam.sweep.pool import Processes
from gearcam.sweep.rows import Built, measured
from helpers_pairs import PROFILES
from helpers_sweep import BASE, odd

distributed = pytest.importorskip("distributed")

Jobs = Sequence[tuple[int, dict[str, Any]]]


@pytest.fixture(scope="module")
def local() -> Iterator[Any]:
    """Two workers of one thread, as on two cores of other machines."""
    with (
        cluster._silent(),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1"
        ) as made,
    ):
        yield made


def pids(local: Any) -> list[int]:
    return [one.pid for one in local.workers.values() if one.pid]


def deeds(*words: str) -> Jobs:
    return [(number, {"deed": word}) for number, word in enumerate(words)]


def rows(local: Any, wanted: Jobs, base: gc.Design = BASE, **settings: Any) -> dict[int, Built]:
    engine = Cluster(**{"address": local.scheduler_address, "measure": odd} | settings)
    found: dict[int, Built] = {}
    for row in engine.run(base, iter(wanted)):
        assert row.number not in found
        found[row.number] = row
    assert sorted(found) == [number for number, _ in wanted]
    return found


def test_rows_are_those_of_processes_to_the_last_bit(local: Any) -> None:
    jobs = [(k, {"law.eccentricity": 0.08 * k, "pair.teeth": [20, 20]}) for k in range(16)]
    here = {row.number: row for row in Processes(jobs=1).run(BASE, iter(jobs))}
    there = rows(local, jobs, measure=measured)
    assert {k: replace(row, time_s=0.0) for k, row in there.items()} == {
        k: replace(row, time_s=0.0) for k, row in here.items()
    }
    assert 0 < sum(not row.made for row in there.values()) < 16


def test_workers_find_the_files_that_a_design_names(
    local: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(PROFILES)  # workers run in another folder
    found = rows(local, [(0, {"pair.module_mm": 2})], gc.load("measured.toml"), measure=measured)
    assert found[0].made
