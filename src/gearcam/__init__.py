"""gearcam: cams and pairs of non-circular gears from a description of their motion.

A *design* describes a motion and what makes it; `build` makes its *result*; the result has numbers,
findings, outlines, charts and files. In Python lengths are in mm and angles in rad; names that end
in a unit, and keys of design files, have that unit.

A design comes from a file (`load`), from the text of one (`loads`), from a dictionary with the same
keys (`design`), or from classes for each kind of design and its parts:

>>> import gearcam as gc
>>> design = gc.load("profiles/ellipse.toml")
>>> same = gc.design(
...     {
...         "kind": "gear-pair",
...         "name": "ellipse",
...         "law": {"type": "ellipse", "eccentricity": 0.3},
...         "pair": {"teeth": [41, 41], "module_mm": 1},
...     }
... )
>>> law = gc.laws.Ellipse(eccentricity=0.3)
>>> pair = gc.PairSpec(teeth=(41, 41), module=1.0)
>>> again = gc.GearPairDesign(name="ellipse", law=law, pair=pair)
>>> result = gc.build(design)  # nothing is computed until it is asked for

*Numbers and findings.* `result.facts` has all numbers by name; `print(result.facts)` shows those
that matter. A finding tells what a check has found; errors mean: do not cut.

>>> round(result.facts["pair.center_distance_mm"], 4)
41.9607
>>> [(one.severity, one.code) for one in result.findings]
[('note', 'no-backlash')]

*Tables, outlines and charts.* Tables are columns for numpy, pandas and polars.

>>> result.motion([0.0, 1.0])["ratio"].round(4)  # at these angles of the driver, rad
array([0.5385, 0.6435])
>>> x, y = result.gear1.outline.T  # mm, the shaft at (0, 0)
>>> result.charts[:3]  # result.plot("ratio") draws one with matplotlib
('ratio', 'pressure_angle', 'contact_ratio')

*Files* of all formats, or of those that you name:

>>> result.write("output", files=["dxf"]).files
('gear1.dxf', 'gear2.dxf', 'pair.dxf', 'summary.json')

*Studies* look at a result more closely: meshing, errors of mounting, forces, stress and others.
Their settings are the keys of their table in a design file; ``help(result.study)`` describes each.

>>> study = result.mesh(steps=36, center_distance_mm=42.0)
>>> round(study.facts["meshing.backlash_mm"]["min"], 4)
0.0287

*Variants.* `with_` returns a changed, checked copy of a design; `record` is one row of a data
frame. `sweep` builds thousands by all cores and gives columns, `optimize` searches the best: as the
commands of the same names do.

>>> round(gc.build(design.with_({"law.eccentricity": 0.2})).facts["pair.ratio"]["max"], 3)
1.5
>>> variants = gc.sweep(design, {"law.eccentricity": [0.1, 0.3]}, jobs=1)
>>> variants.columns["pair.ratio.max"].round(3)
array([1.222, 1.857])

*Errors* name the cause: `DesignError` lists the mistakes in a design, `InfeasibleError`
tells why it cannot be made and the nearest value that can; `remedies` searches for changes that
make it work.

Where to go on: ``dir(gearcam)`` lists the classes and functions, ``dir(gearcam.laws)`` the ratio
laws of gears, ``dir(gearcam.motion_laws)`` the motion laws of cams, ``dir(result)`` and
``dir(study)`` what these have; ``help`` of each shows an example. ``gearcam --help`` in a shell
lists the commands, ``gearcam new gear-pair my.toml`` writes a design file to start from, and
``gearcam skill`` writes a page on design files for coding assistants.

Importing the package is fast: modules are loaded when they are needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gearcam.base.registry import lazy_names
from gearcam.version import __version__

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from gearcam import laws
    from gearcam.base.errors import (
        DesignError,
        GearcamError,
        InfeasibleError,
        MissingExtraError,
        WriteError,
    )
    from gearcam.base.facts import Facts
    from gearcam.base.findings import Finding
    from gearcam.base.tolerances import Tolerances
    from gearcam.designs import Design
    from gearcam.kinds import *  # noqa: F403
    from gearcam.kinds import build
    from gearcam.laws import motion as motion_laws
    from gearcam.numeric.columns import Columns
    from gearcam.parts.fits import FitSize
    from gearcam.results.advice import Remedies
    from gearcam.results.result import Result
    from gearcam.results.study import StudyResult
    from gearcam.sweeps.search import Optimum, optimize
    from gearcam.sweeps.sweep import Sweep, sweep


__all__ = [
    "Columns", "Design", "DesignError", "Facts", "Finding", "FitSize", "GearcamError",
    "InfeasibleError", "MissingExtraError", "Optimum", "Result", "StudyResult", "Sweep",
    "Tolerances", "WriteError",
    "__version__",
    "build",
    "design", "laws", "load", "loads", "motion_laws", "optimize", "remedies", "sweep",
]  # fmt: skip

_HOMES = {
    "gearcam.designs": ("Design",),
    "gearcam.base.errors": (
        "DesignError", "GearcamError", "InfeasibleError", "MissingExtraError", "WriteError",
    ),
    "gearcam.base.facts": ("Facts",),
    "gearcam.base.findings": ("Finding",),
    "gearcam.kinds": ("build",),
    "gearcam.laws": ("laws",),
    "gearcam.laws.motion": ("motion_laws",),
    "gearcam.numeric.columns": ("Columns",),
    "gearcam.parts.fits": ("FitSize",),
    "gearcam.results.result": ("Result",),
    "gearcam.results.study": ("StudyResult",),
    "gearcam.sweeps.search": ("Optimum", "optimize"),
    "gearcam.sweeps.sweep": ("Sweep", "sweep"),
    "gearcam.base.tolerances": ("Tolerances",),
}  # fmt: skip
"""Names that are imported on demand, by their modules; kinds of design add theirs."""


def _of_kinds() -> dict[str, type]:
    from gearcam.results.kind import KINDS

    return {name: one for kind in KINDS.values() for name, one in kind.public.items()}


if not TYPE_CHECKING:  # so that type checkers report misspelt names
    __getattr__, _ = lazy_names("gearcam has no", _of_kinds, _HOMES)


def __dir__() -> list[str]:
    return sorted({*__all__, *_of_kinds()})


def load(path: str | os.PathLike[str]) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : path
        A TOML file; ``-`` is the standard input.

    Returns
    -------
    Design
        The design, in mm and rad; its class depends on ``kind`` in the file.

    Raises
    ------
    DesignError
        With all mistakes in the file at once.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.load("profiles/ellipse.toml").name
    'ellipse'
    """
    from os import PathLike

    from gearcam.designs import load as read
    from gearcam.numeric.arguments import instance

    return read(instance("path", path, (str, PathLike), "a path"))


def loads(text: str) -> Design:
    """Read the text of a design file.

    Parameters
    ----------
    text : str
        TOML with a key ``name``. Paths of CSV files are relative to the current folder.

    Returns
    -------
    Design
        As from `load`.

    Raises
    ------
    DesignError
        With all mistakes in the text at once, each with its line.

    Examples
    --------
    >>> import gearcam as gc
    >>> from pathlib import Path
    >>> gc.loads(Path("profiles/ellipse.toml").read_text()).name
    'ellipse'
    """
    from gearcam.designs import loads as read
    from gearcam.numeric.arguments import instance

    return read(instance("text", text, str, "the text of a design file"))


def design(document: Mapping[str, Any]) -> Design:
    """Return a design from nested dictionaries with the content of a design file.

    Parameters
    ----------
    document : mapping
        Keys and values as in a design file, in its units, including ``kind`` and ``name``.

    Returns
    -------
    Design
        As from `load`.

    Raises
    ------
    DesignError
        With all mistakes at once, each with its key.

    Examples
    --------
    >>> import gearcam as gc
    >>> document = gc.load("profiles/ellipse.toml").to_dict()
    >>> document["law"]["eccentricity"] = 0.2
    >>> gc.design(document).name
    'ellipse'
    """
    from collections.abc import Mapping

    from gearcam.designs import design as made
    from gearcam.numeric.arguments import instance

    return made(instance("document", document, Mapping, "a mapping of the keys of a design file"))


def remedies(
    result: Result, refusal: InfeasibleError | None = None, *, patience: float = 6.0
) -> Remedies:
    """Search for changes that make a refused design, or one with errors, work.

    Parameters
    ----------
    result : Result
        From `build`.
    refusal : InfeasibleError, optional
        The error with which it was refused; found by building it by default.
    patience : float, s
        Time of the search on a usual machine, at ten designs a second. Designs are counted, not
        time, so that the answer is the same everywhere.

    Returns
    -------
    Remedies
        Each was built without refusal and without findings of severity ``error``.

    Raises
    ------
    DesignError
        If the argument is not a result.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml").with_({"blank.bore_diameter_mm": 60})
    >>> found = gc.remedies(gc.build(design), patience=60.0).found
    >>> [list(one.changes) for one in found]
    [['blank.bore_diameter_mm']]
    """
    from gearcam.numeric.arguments import instance
    from gearcam.results.advice import remedies as search
    from gearcam.results.result import Result

    instance("result", result, Result, "a result, as returned by build")
    return search(result, refusal, patience=patience)
