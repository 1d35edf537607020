"""The table ``[drawing]``: what the title block and the notes of workshop drawings say.

Depends on quantities only.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, fields
from datetime import date
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import LENGTH, TEXT, param
from gearcam.base.rules import Breach

_LONGEST: Final = 60
"""Characters that a cell of the title block can show."""

_SURFACE: Final = re.compile(r"R[az] \d+(\.\d+)?")


def _text(*, example: str, doc: str, both: bool = False) -> Any:
    return param(TEXT, default=None, example=example, doc=doc, both=both)


_NUMBER: Final = "identification number; one for several parts gets -1, -2; file names if left out"
_MATERIAL: Final = "material, as it is ordered"
_TREATMENT: Final = "heat treatment"


def _tolerance(*, example: float, doc: str) -> Any:
    return param(LENGTH, default=None, gt=0, le=10, example=example, doc=doc)


@dataclass(frozen=True, kw_only=True)
class DrawingNotes(ShortRepr):
    """What all workshop drawings of a design say: tolerances, who and when."""

    surface: str | None = _text(example="Ra 1.6", doc="surface texture all over, such as Ra 1.6")
    general_tolerances: str | None = _text(
        example="ISO 2768-mK", doc="tolerances of sizes without their own"
    )
    runout: float | None = _tolerance(
        example=0.03,
        doc="circular run-out about the bore, the datum B: of the outside if it is a cylinder, "
        "else of the face",
    )
    profile_tolerance: float | None = _tolerance(
        example=0.02, doc="tolerance of the form of the outline or groove"
    )
    revision: str | None = _text(example="B", doc="revision index")
    author: str | None = _text(example="A. Maker", doc="who made the drawing")
    approved_by: str | None = _text(example="B. Checker", doc="who approved it")
    owner: str | None = _text(example="Example Works", doc="legal owner of the drawing")
    date: str | None = _text(example="2030-01-31", doc="date of issue; no date if left out")

    def problems(self) -> Iterator[Breach]:
        """Yield texts that a drawing cannot show: field, index, message, allowed."""
        for one in fields(self):
            value = getattr(self, one.name)
            for number, text in enumerate(value if isinstance(value, tuple) else (value,)):
                bare = text == "" and isinstance(value, tuple)  # of one wheel it is left out
                if isinstance(text, str) and not bare and not 0 < len(text.strip()) <= _LONGEST:
                    what = "is too long for its cell" if text.strip() else "is empty"
                    index = number if isinstance(value, tuple) else None
                    without = "leave it out" if index is None else '"" for none'
                    yield one.name, index, what, f"1 to {_LONGEST} characters, or {without}"
        if self.date is not None and not _is_date(self.date):
            yield "date", None, "is not a date", "year-month-day, such as 2030-01-31"
        if self.surface is not None and not _SURFACE.fullmatch(self.surface):
            yield "surface", None, "is not a surface texture", "Ra or Rz and micrometres: Ra 1.6"

    def of(self, name: str, number: int | None) -> str:
        """Return the text `name` of the part of a `number` from 0, or of all; empty without one."""
        value: str | tuple[str, str] = getattr(self, name) or ""
        if not isinstance(value, tuple):
            return value
        if number is not None or not any(value):
            return value[number or 0]
        return " + ".join(dict.fromkeys(one or "-" for one in value))


@dataclass(frozen=True, kw_only=True)
class DrawingSpec(DrawingNotes):
    """What workshop drawings say beside sizes: part number, material, tolerances, who and when.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.DrawingSpec(material="C45E", general_tolerances="ISO 2768-mK")
    DrawingSpec(general_tolerances='ISO 2768-mK', material='C45E')
    """

    part_number: str | None = _text(example="G-1024", doc=_NUMBER)
    material: str | None = _text(example="C45E", doc=_MATERIAL)
    heat_treatment: str | None = _text(example="hardened, 50 to 54 HRC", doc=_TREATMENT)


@dataclass(frozen=True, kw_only=True)
class PairDrawingSpec(DrawingNotes):
    """What workshop drawings of a pair say beside sizes, some of it for each wheel.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PairDrawingSpec(material=("C45E", "POM"))
    PairDrawingSpec(material=('C45E', 'POM'))
    """

    part_number: tuple[str, str] | None = _text(example="G-1024", doc=_NUMBER, both=True)
    material: tuple[str, str] | None = _text(example="C45E", doc=_MATERIAL, both=True)
    heat_treatment: tuple[str, str] | None = _text(
        example="hardened, 50 to 54 HRC", doc=_TREATMENT, both=True
    )


def _is_date(text: str) -> bool:
    try:
        return date.fromisoformat(text).isoformat() == text
    except ValueError:
        return False
