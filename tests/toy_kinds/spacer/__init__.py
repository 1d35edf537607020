"""A kind of design that only a test knows: spacers, flat rings."""

from gearcam.base.registry import deferred
from gearcam.results.studies import Study

STUDIES = (
    Study(
        name="weigh",
        key="weight",
        doc="Weigh a spacer.",
        done="weighed",
        table="weight",
        compute=deferred("gearcam.kinds.spacer.design:_weigh"),
    ),
)
