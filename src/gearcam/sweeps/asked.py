"""What a sweep or a search is asked for: the design, what its keys get, the engine.

The same words are the arguments of `gearcam.sweep`, the options of the command (``--jobs``), and
keys of the table ``[sweep]`` of a design file. What is given comes before the table. Values for
keys are what the table takes (see `gearcam.sweeps.axes`): texts such as ``"0.05:0.6:0.01"``, values
and lists of values, in the units of a design file. From Python arrays and ranges are lists too.

Refused: keys that do not exist, values that cannot be read, numbers that are not above 0.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError
from gearcam.designs.design import Design, load
from gearcam.designs.reader import content_of, decoded, document_in
from gearcam.sweeps.axes import Varied, axes_of
from gearcam.sweeps.engine import MEMORY, SECONDS, Engine
from gearcam.sweeps.plan import Plan, flattened
from gearcam.sweeps.pool import Processes, default_jobs

TITLE: Final = "sweep"
"""Title of the table of a design file."""

_SETTINGS: Final = ("random", "latin", "seed")
"""Keys of ``[sweep]`` that are not keys of the design."""

LIMIT: Final = SECONDS
"""Default limit of a variant's time, s."""

GIGABYTES: Final = MEMORY / 2**30
"""Default limit of a process's memory, GB."""


@dataclass(frozen=True, kw_only=True)
class Asked(ShortRepr):
    """What is varied, of which design.

    Parameters
    ----------
    base : Design
        The design.
    axes : tuple of Varied
        What its keys get.
    samples : mapping of str to value
        ``random``, ``latin`` and ``seed`` of the table of its file; None where not given.
    """

    base: Design
    axes: tuple[Varied, ...]
    samples: Mapping[str, Any]

    def plan(self, given: Mapping[str, int | None]) -> Plan:
        """Return the variants of a sweep.

        Parameters
        ----------
        given : mapping of str to int or None
            ``random``, ``latin`` and ``seed``, which come before those of the file.

        Raises
        ------
        DesignError
            If a number is not allowed, or no value of a key is.
        """
        samples = {**self.samples, **{name: one for name, one in given.items() if one is not None}}
        for name in ("random", "latin"):
            one = samples[name]
            if one is not None and not (type(one) is int and one > 0):
                message = "is not a number of samples"
                raise DesignError.of(message, key=name, value=one, allowed="1 or more")
        seed = 1 if samples["seed"] is None else samples["seed"]
        if type(seed) is not int or seed < 0:
            raise DesignError.of("is not a seed", key="seed", value=seed, allowed="0 or more")
        if samples["random"] and samples["latin"]:
            raise DesignError.of("random and latin are both given", allowed="one of them")
        sampling: Any = next((name for name in ("random", "latin") if samples[name]), "grid")
        return Plan(
            base=self.base,
            axes=self.axes,
            sampling=sampling,
            samples=samples[sampling] if sampling != "grid" else 0,
            seed=seed,
        )


def asked(design: Any, keys: Mapping[str, Any] | None, place: str = "keys") -> Asked:
    """Return what is varied, of which design.

    Parameters
    ----------
    design : Design or path
        A design, or a design file, whose table ``[sweep]`` counts too.
    keys : mapping of str to value, optional
        What keys get; before the table.
    place : str
        Where they are given, for messages.

    Raises
    ------
    DesignError
        If nothing is to be varied, or what is given cannot be read.
    """
    if not isinstance(design, Design | str | os.PathLike):
        allowed = "a design, or the path of a design file"
        raise DesignError.of("is no design", key="design", value=design, allowed=allowed)
    if not isinstance(keys, Mapping | None):
        allowed = "a mapping of keys of the design to what they get"
        raise DesignError.of("is no mapping", key=place, value=keys, allowed=allowed)
    table: dict[str, Any] = {}
    if not isinstance(design, Design):
        file, design = os.fspath(design), load(design)
        table = dict(document_in(decoded(content_of(file), file), file).get(TITLE, {}))
    samples = {name: table.pop(name, None) for name in _SETTINGS}
    axes = {one.key: one for one in axes_of(flattened(table), TITLE)}
    given = {str(key): plain(one) for key, one in (keys or {}).items()}
    axes |= {one.key: one for one in axes_of(given, place)}
    if not axes:
        allowed = "a table [sweep], or " + ("--set KEY=..." if place == "--set" else "keys")
        raise DesignError.of("nothing is to be varied", allowed=allowed)
    return Asked(base=design, axes=tuple(axes.values()), samples=samples)


def plain(value: Any) -> Any:
    """Return a value in the types of a design file: arrays, ranges and tuples are lists."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    return [plain(one) for one in value] if isinstance(value, list | tuple | range) else value


def engine_of(
    *,
    jobs: int | None = None,
    client: Any = None,
    scheduler: str | None = None,
    limit: float = LIMIT,
    memory: float = GIGABYTES,
    prefix: str = "",
) -> Engine:
    """Return what builds variants.

    Parameters
    ----------
    jobs : int, optional
        Number of processes of this machine; all cores by default.
    client : object, optional
        A client of dask, or an executor, whose workers build instead.
    scheduler : str, optional
        Address of a scheduler of dask, whose workers build instead.
    limit : float, s
        Largest time of a variant.
    memory : float, GB
        Largest memory of a process.
    prefix : str
        Before the names of arguments in messages.

    Raises
    ------
    DesignError
        If an argument has a value that is not allowed, or nothing answers at the address.
    """
    for name, value in (("jobs", jobs), ("limit", limit), ("memory", memory)):
        if value is not None and not _is_positive(value, whole=name == "jobs"):
            what = "is not a number of processes" if isinstance(value, str) else "is not above 0"
            raise DesignError.of(what, key=f"{prefix}{name}", value=value, allowed="above 0")
    limits: dict[str, Any] = {"seconds": limit, "memory": int(memory * 2**30)}
    if client is not None:
        if jobs is not None:
            raise DesignError.of("jobs and client are both given", allowed="one of them")
        return _engine_with(client, limits)
    if scheduler:
        from gearcam.sweeps.cluster import Cluster

        return Cluster(address=scheduler, **limits)
    return Processes(jobs=jobs or default_jobs(), **limits)


def _is_positive(value: Any, *, whole: bool) -> bool:
    if isinstance(value, bool) or not isinstance(value, int if whole else int | float):
        return False
    return value > 0


def _engine_with(client: Any, limits: Mapping[str, Any]) -> Engine:
    """Return the engine of a client of dask or of an executor."""
    if not callable(getattr(client, "submit", None)):
        allowed = "a client of dask.distributed, or an executor with submit(function, *arguments)"
        raise DesignError.of("has no submit", key="client", value=client, allowed=allowed)
    if type(client).__module__.partition(".")[0] == "distributed":
        from gearcam.sweeps.cluster import Cluster

        return Cluster(client=client, **limits)
    from gearcam.sweeps.futures import Futures

    return Futures(executor=client, **limits)
