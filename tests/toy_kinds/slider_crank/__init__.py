"""A kind of design that only a test knows: slider-cranks."""

from gearcam.base.registry import deferred
from gearcam.results.studies import Study

STUDIES = (
    Study(
        name="slide",
        key="stroke",
        doc="Compute the slider's motion.",
        done="computed",
        table="stroke",
        compute=deferred("gearcam.kinds.slider_crank.design:_stroke"),
    ),
)
