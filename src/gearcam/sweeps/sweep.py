"""Sweeps from Python: ``gearcam.sweep``, of which the command is a caller.

    import gearcam as gc

    sweep = gc.sweep("profiles/ellipse.toml", {"law.eccentricity": "0.1:0.5:0.1"}, jobs=2)
    for row in sweep:  # as they are built
        print(row.number, row.values, row.facts["pair.ratio.max"], row.refusal)
    e, ratio = sweep.columns["law.eccentricity"], sweep.columns["pair.ratio.max"]

A *sweep* gives values to keys of a design; each combination is a *variant*, which leaves a *row*:
its values, facts, codes of findings or the reason of its refusal. Words as in `gearcam.sweeps`.

Inputs: a design, or a design file with a table ``[sweep]``; what its keys get, in the units of a
design file (mm, deg); samples and their seed; processes, a client of dask or an executor; limits of
a variant's time (s) and of a process's memory (GB); a folder for the log.

Outputs: rows as they come; columns, arrays with one value for each variant, by its number, whose
names are keys and facts with their units; the tables and the page that the command writes.

With a folder each row is written to its ``sweep.log`` as it comes: the same sweep goes on from
there, also after the program was ended. Without one, rows are kept in memory: what was not built
when an iteration ended is built by the next one.

Refused before anything is built: keys that do not exist, values that are not allowed, ranges
without a step where no samples are asked for, a folder with the log of another sweep, wrong numbers
of processes and limits, scripts without ``if __name__ == "__main__":``. A variant that cannot be
made refuses nothing: its row has the reason.
"""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Final

from gearcam.base.display import cut
from gearcam.base.errors import DesignError
from gearcam.base.processes import end_if_unguarded
from gearcam.designs.design import Design
from gearcam.numeric.columns import Columns
from gearcam.sweeps.asked import GIGABYTES, LIMIT, asked, engine_of
from gearcam.sweeps.engine import Engine, missing_rows
from gearcam.sweeps.kept import Kept, RowStore
from gearcam.sweeps.log import Log
from gearcam.sweeps.plan import Plan
from gearcam.sweeps.rows import Built
from gearcam.sweeps.tables import (
    Tally,
    columns_of,
    made_folder,
    tally_of,
    write_tables,
    written_whole,
)

DRAWN: Final = 100_000
"""Largest number of variants that a page shows."""

Progress = Callable[[int, int], Any]
"""``progress(done, total)`` is called with the number of rows that are there and their total."""


class Sweep(AbstractContextManager["Sweep"]):
    """A sweep: its variants, and the rows that are there.

    It is iterated for rows as they come. Asked for `columns` or `rows` it builds what is missing.

    Parameters
    ----------
    plan : Plan
        Its variants.
    engine : Engine
        What builds them.
    folder : path, optional
        Folder of the log; without one rows are kept in memory.
    progress : callable, optional
        Called with the number of rows that are there and their total, after each.

    Raises
    ------
    DesignError
        If the folder has the log of another sweep.
    WriteError
        If the log cannot be written.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml")
    >>> sweep = gc.sweep(design, {"pair.module_mm": [1, 2]}, jobs=1)
    >>> [row.values for row in sweep]
    [{'pair.module_mm': 1}, {'pair.module_mm': 2}]
    """

    def __init__(
        self,
        plan: Plan,
        engine: Engine,
        folder: str | os.PathLike[str] | None = None,
        progress: Progress | None = None,
    ) -> None:
        self.plan, self.engine, self._progress = plan, engine, progress
        self.folder = None if folder is None else Path(folder)
        self._there: RowStore = Kept() if folder is None else Log(folder, plan.head)
        weakref.finalize(self, self._there.close)
        self._columns: tuple[int, Columns] | None = None

    def __repr__(self) -> str:
        varied = ", ".join(axis.key for axis in self.plan.axes)
        return cut(f'<Sweep of "{self.plan.base.name}": {self.done} of {len(self)}; {varied}>')

    def __len__(self) -> int:
        return self.plan.count

    def __iter__(self) -> Iterator[Built]:
        yield from self._there.rows()
        yield from self.missing()

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the log: nothing more can be asked for."""
        self._there.close()

    @property
    def done(self) -> int:
        """Number of rows that are there."""
        return len(self._there)

    def missing(self) -> Iterator[Built]:
        """Build the variants that are missing; yield their rows as they come, in any order."""
        for row in missing_rows(self.plan, self._there, self.engine):
            if self._progress is not None:
                self._progress(self.done, len(self))
            yield row

    def _complete(self) -> None:
        if self.done < len(self):
            for _ in self.missing():
                pass

    @property
    def rows(self) -> list[Built]:
        """The rows by their numbers; what is missing is built."""
        self._complete()
        return list(self._there.rows())

    @property
    def columns(self) -> Columns:
        """Arrays (n,) by name, a value for each variant by its number; what is missing is built.

        ``number``; the values by their keys; the facts by their names; ``findings``, their codes;
        ``errors``, how many of them are errors; ``refusal``, the reason; ``time_s``. A number that
        a variant does not have is nan, also that of a key that None leaves out. Lists are texts.
        The other name of a key, as `pair.rack.addendum` of `rack.addendum`, finds its column too.
        """
        self._complete()
        if self._columns is None or self._columns[0] != self.done:
            self._columns = self.done, columns_of(self._there, self.plan.repeated)
        return self._columns[1]

    @property
    def tally(self) -> Tally:
        """How many rows are there, are refused, have errors."""
        return tally_of(self._there.rows())

    def design(self, number: int) -> Design:
        """Return the design of a variant.

        Parameters
        ----------
        number : int
            Its number, from 0.

        Raises
        ------
        DesignError
            If there is no such variant, or its values are not allowed.
        """
        if type(number) is not int or not 0 <= number < len(self):
            allowed = f"0 to {len(self) - 1}"
            raise DesignError.of("is no variant", key="number", value=number, allowed=allowed)
        return self.plan.base.with_(self.plan.values(number))

    def write(self, folder: str | os.PathLike[str] | None = None) -> list[Path]:
        """Write ``sweep.csv``, with pyarrow ``sweep.parquet``, and the page ``sweep.html``.

        Parameters
        ----------
        folder : path, optional
            Where; the folder of the log by default.

        Returns
        -------
        list of path
            The files, of the rows that are there; the page only up to 100 000 rows.

        Raises
        ------
        DesignError
            If there is no folder.
        WriteError
            If a file cannot be written.
        """
        place = made_folder(self.folder if folder is None else folder)
        tally, files = write_tables(self._there, place)
        if not tally.rows or tally.rows > DRAWN:
            return files
        from gearcam.sweeps.page import PAGE, page

        content = page(self.plan.base, self._there.rows(), self._lines(tally))
        written_whole(place / PAGE, lambda path: path.write_bytes(content))
        return [*files, place / PAGE]

    def _lines(self, tally: Tally) -> list[str]:
        """Return what the page says at its top."""
        plan = self.plan
        how = "all combinations" if plan.sampling == "grid" else f"{plan.sampling} samples"
        return [
            *(f"{axis.key} = {axis.text}" for axis in plan.axes),
            f"{how}; {tally.rows} of {plan.count} built; {tally.words}",
        ]


def sweep(
    design: Design | str | os.PathLike[str],
    keys: Mapping[str, Any] | None = None,
    *,
    random: int | None = None,
    latin: int | None = None,
    seed: int | None = None,
    jobs: int | None = None,
    client: Any = None,
    limit: float = LIMIT,
    memory: float = GIGABYTES,
    folder: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Sweep:
    """Build variants of a design, as the command ``gearcam sweep`` does.

    Nothing is built until the sweep is iterated, or asked for its columns. In a script it has to
    stand under ``if __name__ == "__main__":``, since other processes read the script.

    Parameters
    ----------
    design : Design or path
        A design, or a design file, whose table ``[sweep]`` counts too.
    keys : mapping of str to value, optional
        What dotted keys of the design get, in the units of a design file: a value, a list or an
        array of values, or a text: ``"0.05:0.6:0.01"``, a range with its end;
        ``"log(1, 100, 20)"``; to be sampled ``"0.05:0.6"``, ``"log(1, 100)"``,
        ``"normal(20, 0.01)"`` (mean and standard deviation) and ``"tolerance(20, 0.05)"`` (20
        within 0.05 to either side). Of several keys all combinations are built.
    random, latin : int, optional
        Number of random samples, or of samples of a Latin hypercube, instead of all combinations.
    seed : int, optional
        Of samples; 1 by default.
    jobs : int, optional
        Number of processes; all cores by default.
    client : object, optional
        A client of dask.distributed, or an executor with ``submit``, whose workers build instead.
    limit : float, s
        Largest time of a variant: one that takes longer is refused.
    memory : float, GB
        Largest memory of a process.
    folder : path, optional
        Folder of the log ``sweep.log``, from which the same sweep goes on.
    progress : callable, optional
        ``progress(done, total)``, called after each row.

    Returns
    -------
    Sweep
        Iterated it yields rows as they come; `columns` are arrays by keys and names of facts.

    Raises
    ------
    DesignError
        If a key does not exist, a value or an argument is not allowed, or the folder has the log of
        another sweep.
    WriteError
        If the log cannot be written.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml")
    >>> sweep = gc.sweep(design, {"law.eccentricity": [0.1, 0.3, 0.99]}, jobs=1)
    >>> sweep.columns["pair.ratio.max"].round(4)
    array([1.2222, 1.8571,    nan])
    """
    end_if_unguarded()
    plan = asked(design, keys).plan({"random": random, "latin": latin, "seed": seed})
    engine = engine_of(jobs=jobs, client=client, limit=limit, memory=memory)
    return Sweep(plan, engine, folder, progress)
