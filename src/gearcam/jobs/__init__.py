"""Jobs: what one kind of design computes, stage by stage, on demand.

`gear_pair` holds the stages of a gear pair, `files` turns a job into the contents of its files,
`summary` into the document that says what was made and how exact it is.
"""

from gearcam.jobs.gear_pair import GearPairJob
from gearcam.jobs.written import Written

__all__ = ["GearPairJob", "Written"]
