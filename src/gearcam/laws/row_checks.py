"""The check of the rows of tables: of motions, rises and ratio laws.

Each table says what its rows are (`FromFile.given`); one check looks at all of a design. Tables
whose rows need not lie on a curve, such as errors of pitch by tooth or loads, are not looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.findings import Finding, Remark, check, run_checks
from gearcam.base.numerals import formatted
from gearcam.laws.columns import Given, tables_in
from gearcam.numeric.stray import stray_rows

KIND: Final = "rows of tables"


@dataclass(frozen=True, kw_only=True)
class StrayRow(ShortRepr):
    """A row of a table that is out of line with those around it.

    Parameters
    ----------
    row : int
        Its number, from 0.
    where : str
        Its line in the file, or its key and index, and its place.
    value : float
        What it says, in the unit of the table.
    text : str
        What is wrong with it, and the value that the rows around it suggest.
    """

    row: int
    where: str
    value: float
    text: str


def stray_in(given: Given) -> Iterator[StrayRow]:
    """Yield the rows of a table that are out of line with those around them.

    Parameters
    ----------
    given : Given
        The rows.
    """
    rows, suggested = stray_rows(given.x, given.y, given.period, given.rise)
    for row, near in zip(rows.tolist(), suggested.tolist(), strict=True):
        line = f"line {given.lines[row]}" if given.lines else f"{given.key}[{row}]"
        value = float(given.y[row])
        told, other = (f"{formatted(one, 4)} {given.unit}".rstrip() for one in (value, near))
        yield StrayRow(
            row=row,
            where=f"{line}, {given.place(float(given.x[row]))}",
            value=value,
            text=f"{given.called} {told} is out of line: the rows around it suggest {other}",
        )


def row_findings(tables: list[tuple[str, Given]]) -> tuple[Finding, ...]:
    """Return the findings of the rows of tables.

    Parameters
    ----------
    tables : list of (str, Given)
        As of `given_in`.
    """
    return run_checks(KIND, tables, {})


def refused_for_row(
    tables: list[tuple[str, Given]], error: InfeasibleError
) -> InfeasibleError | None:
    """Return the refusal of the first stray row of tables, from which another may follow.

    Parameters
    ----------
    tables : list of (str, Given)
        As of `given_in`.
    error : InfeasibleError
        The other refusal.
    """
    for place, given in tables:
        for row in stray_in(given):
            where, note = f"{place}, {row.where}", f"as it is, {error.what}"
            return InfeasibleError(f"the {row.text}", where=where, nearest=note)
    return None


def given_in(design: Any, *, oscillating: bool) -> Iterator[tuple[str, Given]]:
    """Yield the rows of a design that should lie on curves, with the key of what they belong to.

    Parameters
    ----------
    design : Design
        Without the designs that are nested in it, which have findings of their own.
    oscillating : bool
        Whether lifts are angles.
    """
    for field in fields(design):
        part = getattr(design, field.name)
        several = isinstance(part, tuple)
        for number, one in enumerate(part if several else (part,)):
            place = f"{field.name}[{number}]" if several else field.name
            for table in tables_in(one):
                given = table.given(oscillating=oscillating)
                if given is not None:
                    yield place, given


@check("stray-row", kind=KIND, severity="error")
def stray_row(tables: list[tuple[str, Given]], limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Find a single row of a table that is out of line: a slip of the decimal point.

    Looks at: each row's distance from the cubic through two rows before and two behind it, against
    those of the rows around it. Corners, dwells and jumps of a table are no slips.
    """
    for place, given in tables:
        for row in stray_in(given):
            yield Remark(
                f"The {row.text}. Is each digit in place?",
                f"{place}, {row.where}",
                row.value,
                unit=given.unit,
            )
