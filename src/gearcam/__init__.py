"""gearcam: from a description of a motion to a cam, or a pair of non-circular gears, to be cut.

    design = gearcam.load("profiles/nail_machine_two_phase.toml")
    result = gearcam.build(design)
    result.pair.module, result.findings, result.gear1.outline
    result.write("output", files=["dxf"])
    gearcam.remedies(result).found  # where it is refused or has errors: what would work

Importing the package loads nothing else: `load` and `build` bring in what they need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, overload

if TYPE_CHECKING:
    import os

    from gearcam.design import CamDesign, Design, GearPairDesign
    from gearcam.errors import InfeasibleError
    from gearcam.jobs import Job
    from gearcam.jobs.cam import CamJob
    from gearcam.jobs.gear_pair import GearPairJob
    from gearcam.jobs.remedies import Remedies

__all__ = ["__version__", "build", "load", "remedies"]

__version__ = "0.1.0"


def load(path: str | os.PathLike[str]) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : path
        A TOML file.

    Returns
    -------
    GearPairDesign or CamDesign
        What is asked for, in mm and rad, as the file's kind says.

    Raises
    ------
    DesignError
        With every problem of the file at once.
    """
    from gearcam.design import load as read

    return read(path)


@overload
def build(design: GearPairDesign) -> GearPairJob: ...
@overload
def build(design: CamDesign) -> CamJob: ...
def build(design: GearPairDesign | CamDesign) -> GearPairJob | CamJob:
    """Return the job of a design; nothing is computed until it is asked for.

    Parameters
    ----------
    design : GearPairDesign or CamDesign
        What is asked for.

    Returns
    -------
    GearPairJob or CamJob
        Its attributes compute what they name and raise `InfeasibleError` for what cannot be made.
    """
    from gearcam.jobs import make_job

    return make_job(design)


def remedies(
    job: Job, refusal: InfeasibleError | None = None, *, patience: float = 6.0
) -> Remedies:
    """Search for changes with which a refused design, or one with errors, can be made.

    Parameters
    ----------
    job : Job
        From `build`.
    refusal : InfeasibleError, optional
        How it was refused; found by building where left out.
    patience : float, s
        Time after which no other design is tried.

    Returns
    -------
    Remedies
        Each was built: nothing is refused, what was an error is gone, and no other has come.
    """
    from gearcam.jobs.remedies import remedies as search

    return search(job, refusal, patience=patience)
