"""gearcam: from a description of a motion to a pair of non-circular gears that can be cut.

    design = gearcam.load("profiles/nail_machine_two_phase.toml")
    result = gearcam.build(design)
    result.pair.module, result.findings, result.gear1.outline
    result.write("output", files=["dxf"])

Importing the package loads nothing else: `load` and `build` bring in what they need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import os

    from gearcam.design import GearPairDesign
    from gearcam.jobs import GearPairJob

__all__ = ["__version__", "build", "load"]

__version__ = "0.1.0"


def load(path: str | os.PathLike[str]) -> GearPairDesign:
    """Read a design file.

    Parameters
    ----------
    path : path
        A TOML file.

    Returns
    -------
    GearPairDesign
        What is asked for, in mm and rad.

    Raises
    ------
    DesignError
        With every problem of the file at once.
    """
    from gearcam.design import load as read

    return read(path)


def build(design: GearPairDesign) -> GearPairJob:
    """Return the job of a design; nothing is computed until it is asked for.

    Parameters
    ----------
    design : GearPairDesign
        What is asked for.

    Returns
    -------
    GearPairJob
        Its attributes compute what they name and raise `InfeasibleError` for what cannot be made.
    """
    from gearcam.jobs import GearPairJob

    return GearPairJob(design)
