"""The engine of a cluster: rows as by processes of this machine, whatever becomes of workers."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError
from gearcam.sweeps import cluster, tasks
from gearcam.sweeps.cluster import Cluster
from gearcam.sweeps.pool import Processes
from gearcam.sweeps.rows import Built, measured
from gearcam.sweeps.tasks import chunk_size
from helpers_pairs import PROFILES
from helpers_sweep import BASE, odd

pytestmark = pytest.mark.skipif(
    find_spec("distributed") is None, reason="needs the extra for clusters"
)

Jobs = Sequence[tuple[int, dict[str, Any]]]


@pytest.fixture(scope="module")
def local() -> Iterator[Any]:
    """Two workers of one thread, as on two cores of other machines.

    What a killed worker had is asked for as long as dask tries to connect: 30 s by default. A
    worker that begins again just 15 s after it was lost would be given up.
    """
    dask: Any = pytest.importorskip("dask")  # they are loaded by the tests that need them
    distributed: Any = pytest.importorskip("distributed")
    settings = {
        "distributed.comm.timeouts.connect": "2s",
        "distributed.deploy.lost-worker-timeout": "300s",
    }
    with (
        cluster._silent(),
        dask.config.set(settings),
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


@pytest.mark.slow
def test_rows_are_those_of_processes_to_the_last_bit(local: Any) -> None:
    jobs = [(k, {"law.eccentricity": 0.08 * k, "pair.teeth": [20, 20]}) for k in range(16)]
    here = {row.number: row for row in Processes(jobs=1).run(BASE, iter(jobs))}
    there = rows(local, jobs, measure=measured)
    assert {k: replace(row, time_s=0.0) for k, row in there.items()} == {
        k: replace(row, time_s=0.0) for k, row in here.items()
    }
    assert 0 < sum(not row.made for row in there.values()) < 16


@pytest.mark.slow
def test_workers_find_the_files_that_a_design_names(
    local: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(PROFILES)  # workers run in another folder
    found = rows(local, [(0, {"pair.module_mm": 2})], gc.load("measured.toml"), measure=measured)
    assert found[0].made


@pytest.mark.slow
def test_lots_of_a_session_are_built_by_the_processes_of_all_workers(local: Any) -> None:
    with Cluster(address=local.scheduler_address, measure=odd).session(BASE) as build:
        pids = [
            {row.facts["pid"] for row in build(deeds(*["nap"] * count))} for count in (4, 6, 1, 4)
        ]
    assert len(set.union(*pids)) == 2
    assert len(pids[1]) == len(pids[3]) == 2


@pytest.mark.slow
def test_a_worker_that_is_killed_costs_nothing(local: Any) -> None:
    wanted = deeds(*["nap"] * 16)
    with Cluster(address=local.scheduler_address, measure=odd).session(BASE) as build:
        found = []
        for row in build(wanted):
            if not found:
                os.kill(pids(local)[0], signal.SIGKILL)
            found.append(row.number)
            assert row.made
    assert sorted(found) == list(range(16))


@pytest.mark.slow
def test_a_variant_with_which_workers_end_costs_only_itself(local: Any) -> None:
    found = rows(local, deeds("work", "end-worker", "work", "work"))
    assert [row.made for _, row in sorted(found.items())] == [True, False, True, True]
    assert "ended twice" in found[1].refusal


def test_chunks_take_about_a_second_and_leave_a_part_to_others() -> None:
    assert chunk_size([], 256) == 1
    assert chunk_size([0.02] * 9, 256) == 50
    assert chunk_size([0.01, 0.03], 4) == 4
    assert chunk_size([1e-320], 256) == 256
    assert chunk_size([3.0], 256) == chunk_size([0.0], 256) == 1


def test_an_address_at_which_nothing_answers_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_ANSWER_S", 0.3)
    with pytest.raises(DesignError, match="no scheduler of dask answers"):
        Cluster(address="tcp://127.0.0.1:1")


def test_other_versions_are_named() -> None:
    here = tasks.versions_here()
    tasks.demand_same(here, {"the scheduler": here})
    there = here | {"distributed": "2020.1", "gearcam": ""}
    with pytest.raises(DesignError) as caught:
        tasks.demand_same(here, {"the scheduler": here, "the worker a": there})
    (problem,) = caught.value.problems
    assert problem.message == (
        f"the worker a has no gearcam, distributed 2020.1 instead of {here['distributed']}"
    )


@pytest.mark.slow
def test_a_client_that_is_given_is_used_and_left_open(local: Any) -> None:
    distributed: Any = pytest.importorskip("distributed")
    keys = {"law.eccentricity": [0.1, 0.2, 0.3, 0.99], "pair.teeth": [(20, 20)]}
    here = gc.sweep(BASE, keys, jobs=1).columns
    with distributed.Client(local, set_as_default=False) as client:
        sweep = gc.sweep(BASE, keys, client=client)
        assert sweep.engine.name == f"dask at {local.scheduler_address}"
        there = sweep.columns
        assert client.submit(abs, -1).result() == 1
    for name in set(here) - {"time_s"}:
        assert there[name].tolist() == pytest.approx(here[name].tolist(), nan_ok=True), name
