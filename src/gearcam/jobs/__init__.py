"""Jobs: what one kind of design computes, stage by stage, on demand.

`job` holds what all jobs have in common, `gear_pair` the stages of a gear pair, `cam` those of a
cam; `files` and `cam_files` turn a job into the contents of its files, `summary` and `cam_summary`
into the document that says what was made and how exact it is. Only the job of the design's kind is
loaded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from gearcam.jobs.job import Job
from gearcam.jobs.written import Written

if TYPE_CHECKING:
    from gearcam.design import CamDesign, GearPairDesign
    from gearcam.jobs.cam import CamJob
    from gearcam.jobs.gear_pair import GearPairJob

__all__ = ["Job", "Written", "make_job"]


def make_job(design: GearPairDesign | CamDesign) -> GearPairJob | CamJob:
    """Return the job of a design; nothing is computed until it is asked for.

    Parameters
    ----------
    design : GearPairDesign or CamDesign
        What is asked for.

    Returns
    -------
    GearPairJob or CamJob
    """
    # by its name: asking for the class of the other kind would load that
    if design.kind == "cam":
        from gearcam.jobs.cam import CamJob

        return CamJob(cast("CamDesign", design))
    from gearcam.jobs.gear_pair import GearPairJob

    return GearPairJob(cast("GearPairDesign", design))
