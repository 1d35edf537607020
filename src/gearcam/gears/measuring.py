"""What a shop measures on a finished wheel: over pins or balls, chords, spans.

Depends on pins and spans.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.gears.outline import Outline
from gearcam.gears.pins import PinMeasures, Pins
from gearcam.gears.spans import Spans, find_spans
from gearcam.gears.track import Wheel
from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.columns import Columns

PIN: Final = "output.pin_diameter_mm"
"""The key of the pins of both wheels."""

_ROCKED: Final = math.radians(1.0)
"""Angle by which jaws rock in the table."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Measuring(ShortRepr):
    """What is measured on the teeth of a wheel.

    Parameters
    ----------
    wheel : {1, 2}
        The wheel.
    outline : Outline
        Its teeth as made.
    inches : bool
        Whether simple sizes of pins are those in inches.
    """

    wheel: Wheel
    outline: Outline
    inches: bool = False

    @cached_property
    def over(self) -> PinMeasures:
        """Over pins, and chords of teeth."""
        return PinMeasures(outline=self.outline, inches=self.inches)

    @cached_property
    def spans(self) -> Spans:
        """Steady readings of flat jaws."""
        return find_spans(self.outline)

    @cached_property
    def numbers(self) -> Ints:
        """Numbers of the whole teeth."""
        toothing = self.outline.toothing
        return np.array(toothing.numbers)[toothing.whole]

    def pins(self, diameter: float | None = None) -> tuple[float, Pins]:
        """Return pins of a diameter, mm, by default the recommended one, and the diameter.

        Raises
        ------
        InfeasibleError
            If pins of this diameter touch both flanks of no space.
        """
        if diameter is None:
            return self.over.recommended, self.over.pins(self.over.recommended)
        pins = self.over.pins(diameter)
        if np.isnan(pins.center).all():
            ends = self.over.thinnest.diameter, self.over.thickest.diameter
            near, limit = self.over.recommended, None
            if np.isfinite(ends[0]).any():
                limit = float(np.clip(diameter, np.nanmin(ends[0]), np.nanmax(ends[1])))
            what = "a pin of this diameter touches both flanks of no tooth space"
            note = f"the recommended pin has {formatted(near)} mm"
            where = f"wheel {self.wheel}, {PIN}[{self.wheel - 1}]"
            raise beyond_limit(what, where, diameter, limit, note, near=near)
        return diameter, pins

    def table(self, diameter: float | None = None) -> Columns:
        """Return a row for each whole tooth and the space after it; columns as in docs/summary.md.

        Parameters
        ----------
        diameter : float, optional, mm
            Of the pins; by default the recommended one.
        """
        diameter, pins = self.pins(diameter)
        count, there = len(self.numbers), np.arange(len(pins.over))

        def filled(values: Array, rows: Ints) -> Array:
            column = np.full(count, np.nan)
            column[rows] = values
            return column

        turns = np.nan if self.outline.toothing.track.slides else 1.0
        alone = np.isnan(pins.over) | (pins.opposite == there)
        of_spaces = {
            "pin_least_mm": self.over.thinnest.diameter,
            "pin_most_mm": self.over.thickest.diameter,
            "x_mm": pins.center.real,
            "y_mm": pins.center.imag,
            "center_radius_mm": turns * np.abs(pins.center),
            "center_deg": turns * (np.degrees(np.angle(pins.center)) % 360.0),
            "contact_radius_before_mm": turns * np.abs(pins.contact[0]),
            "contact_radius_after_mm": turns * np.abs(pins.contact[1]),
            "root_gap_mm": pins.root_gap,
            "stands_out_mm": pins.stands_out,
            "opposite": np.where(alone, np.nan, self.numbers[pins.opposite]),
            "over_pins_mm": pins.over,
        }
        # of each tooth the span from it that is touched nearest to the middle of the flanks
        spans = self.spans
        order = np.lexsort((spans.off, spans.first))
        best = order[np.diff(spans.first[order], prepend=-1) > 0]
        from_there = np.searchsorted(self.numbers, spans.first[best])
        of_spans = {
            "span_teeth": spans.teeth,
            "span_mm": spans.reading,
            "span_radius_first_mm": np.abs(spans.contact[1]),
            "span_radius_last_mm": np.abs(spans.contact[0]),
            "span_rocked_1deg_mm": spans.rocked * _ROCKED**2,
        }
        return Columns(
            {
                "tooth": self.numbers,
                "pin_diameter_mm": np.full(count, diameter),
                **{name: filled(values, there) for name, values in of_spaces.items()},
                **{f"{name}_mm": values for name, values in self.over.chords.items()},
                **{name: filled(values[best], from_there) for name, values in of_spans.items()},
            }
        )

    def span(self, first: int, teeth: int) -> float:
        """Return the steady reading of flat jaws over some teeth, mm.

        Parameters
        ----------
        first : int
            Number of the first tooth between the jaws.
        teeth : int
            How many teeth are between them.

        Raises
        ------
        InfeasibleError
            If no reading is steady there; it names the nearest place where one is.
        """
        spans = self.spans
        at = np.flatnonzero((spans.first == first) & (spans.teeth == teeth))
        if len(at):
            return float(spans.reading[at[0]])
        what = f"no reading over {teeth} teeth from tooth {first} on is steady: both flanks have "
        what += "no common normal"
        note = "no flanks of this wheel have one: measure over pins"
        if len(spans.first):
            z, closed = len(self.numbers), self.outline.toothing.closed
            away = spans.first + 0.5 * spans.teeth - (first + 0.5 * teeth)
            away = (away + 0.5 * z) % z - 0.5 * z if closed else away
            near = int(np.lexsort((spans.off, np.abs(spans.teeth - teeth), np.abs(away)))[0])
            note = f"the nearest is over teeth {spans.first[near]} to {spans.last[near]}, "
            note += f"{spans.teeth[near]} teeth: {formatted(float(spans.reading[near]))} mm"
        raise InfeasibleError(what, where=f"wheel {self.wheel}", nearest=note)
