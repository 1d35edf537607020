r"""Tables: columns of numbers, and of texts, as CSV.

Numbers are written as `numerals.exact` gives them, with the fewest digits that read back as the
same double, those of a column of integers without a point; the radius of a straight part is
``inf``; what a masked array masks does not exist and is left empty; lines end in ``\n``. Refused:
other numbers that are not finite, columns of different lengths, names that would need quotes.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import NotFiniteError
from gearcam.base.inches import file_unit
from gearcam.base.numerals import SHORT, ULPS, exact
from gearcam.numeric.arrays import Array, Plane

_NEAR: Final = 8.0 * ULPS * float(np.finfo(float).eps)
"""Relative distance from a short decimal up to which a number is looked at closely: rounding of
the power of ten included."""


_RADII: Final = "rho"
"""Beginning of the names of columns that are radii of curvature: infinite where straight."""


def _in_unit(name: str, values: ArrayLike, full: str | None) -> tuple[str, ArrayLike]:
    """Return the name and the values of a column in the unit of files."""
    named, factor = file_unit().column(full or name)
    return name if full else named, values if factor == 1.0 else np.ma.asanyarray(values) * factor


def table_bytes(columns: Mapping[str, ArrayLike], full: Mapping[str, str] | None = None) -> bytes:
    """Write columns under a header line.

    Parameters
    ----------
    columns : mapping of str to (n,) array
        In mm and in order; the name carries the unit's suffix, such as ``x_mm``, or ``x_in`` in
        files in inches. Texts are written in quotes
        if they need them.
    full : mapping of str to str, or None
        Of columns without the suffix, a name with it: ``lift_mm`` of ``s``.

    Returns
    -------
    bytes
        The file, ASCII but for texts, UTF-8.

    Raises
    ------
    NotFiniteError
        If a number is not finite, other than the radius of a straight part.
    ValueError
        If the columns differ in length, or a name holds a comma, a quote or a line break.
    """
    full = full or {}
    columns = dict(_in_unit(name, values, full.get(name)) for name, values in columns.items())
    bad = [name for name in columns if not name or set(name) & set(',"\r\n')]
    if bad:
        raise ValueError(f"not allowed as column names: {bad}")
    texts = {name: one for name, one in columns.items() if np.asarray(one).dtype.kind == "U"}
    if texts:
        return _with_texts(columns, texts)
    arrays = {name: np.asarray(values, dtype=float).ravel() for name, values in columns.items()}
    lengths = {name: len(values) for name, values in arrays.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"columns have different lengths: {lengths}")
    tidy: list[list[float | None]] = []
    for name, plain in arrays.items():
        # asked for so, since numpy.ma takes as long to load as a table to write
        missing = np.broadcast_to(np.ravel(getattr(columns[name], "mask", False)), plain.shape)
        wrong = np.isnan(plain) if name.startswith(_RADII) else ~np.isfinite(plain)
        bad_rows = np.flatnonzero(wrong & ~missing)
        if bad_rows.size:
            raise NotFiniteError(f"column {name} in row {bad_rows[0]}", float(plain[bad_rows[0]]))
        # One infinity, one zero: a straight part has no side, and -0.0 says nothing.
        # What is missing may be anything, and adding to it may warn.
        there = _exact(np.where(missing, 0.0, plain) + 0.0)
        there = np.where(missing, np.nan, np.where(np.isinf(there), np.inf, there))
        if np.asarray(columns[name]).dtype.kind in "iub":
            numbers = plain.astype(int).tolist()
            tidy.append([None if no else one for one, no in zip(numbers, missing, strict=True)])
        else:
            tidy.append(there.tolist())
    # written in one go, a list of lists has its numbers as `repr` gives each of them
    rows = repr([*map(list, zip(*tidy, strict=True))])[1:-1]
    for mark, other in (
        ("], ", ""), ("[", "\n"), ("]", ""), (", ", ","), ("nan", ""), ("None", "")
    ):  # fmt: skip
        rows = rows.replace(mark, other)
    return (",".join(arrays) + rows + "\n").encode("ascii")


def _with_texts(columns: Mapping[str, ArrayLike], texts: Mapping[str, ArrayLike]) -> bytes:
    """Write columns of which some are texts."""
    numbers = {name: one for name, one in columns.items() if name not in texts}
    head, *rows = (line.split(",") for line in table_bytes(numbers).decode().splitlines())
    cells: dict[str, Sequence[str]] = dict(zip(head, zip(*rows, strict=True), strict=True))
    cells |= {name: np.asarray(one).tolist() for name, one in texts.items()}
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([[*columns], *zip(*(cells[name] for name in columns), strict=True)])
    return text.getvalue().encode()


def _exact(values: Array) -> Array:
    """Return what `numerals.exact` gives for each of the `values`: most it would not change."""
    with np.errstate(all="ignore"):
        scaled = np.abs(values) * 10.0 ** (SHORT - 1 - np.floor(np.log10(np.abs(values))))
        near = np.flatnonzero(~(np.abs(scaled - np.rint(scaled)) > _NEAR * scaled))
    values[near] = [exact(value) for value in values[near].tolist()]
    return values


def motion_bytes(table: Mapping[str, ArrayLike]) -> bytes:
    """Write the motion of a follower: its lift and three derivatives, in the columns 1 to 4, as s.

    Parameters
    ----------
    table : mapping of str to (n,) array
        Columns of `motion` of a cam.

    Returns
    -------
    bytes
        The file (see `table_bytes`).
    """
    full = dict[str, str](zip(("s", "ds", "d2s", "d3s"), [*table][1:5], strict=True))
    short = {name: one for one, name in full.items()}
    return table_bytes({short.get(name, name): values for name, values in table.items()}, full)


def outline_bytes(points: Plane) -> bytes:
    """Write the complex points of an outline, mm, as the columns x_mm and y_mm."""
    return table_bytes({"x_mm": points.real, "y_mm": points.imag})
