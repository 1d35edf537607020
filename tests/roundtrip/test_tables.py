"""Tables read back, by the csv module, as the very same numbers."""

from __future__ import annotations

import csv
import io
import math

import numpy as np
import pytest

from gearcam.base.errors import NotFiniteError
from gearcam.export.table import outline_bytes, table_bytes
from gearcam.numeric.arrays import as_complex


def read(data: bytes) -> tuple[list[str], list[list[float]]]:
    rows = list(csv.reader(io.StringIO(data.decode("ascii"), newline="")))
    return rows[0], [[float(text) for text in row] for row in rows[1:]]


def test_numbers_survive_to_the_last_bit() -> None:
    random = np.random.default_rng(0)
    values = random.standard_normal((500, 2)) * 10.0 ** random.integers(-20, 20, (500, 2))
    head, rows = read(outline_bytes(as_complex(values)))
    assert head == ["x_mm", "y_mm"]
    assert (np.array(rows) == values).all()


def test_the_radius_of_a_straight_part_is_inf() -> None:
    data = table_bytes({"s_mm": [0.0, 1.0, 2.0], "rho_mm": [np.inf, -np.inf, -3.5]})
    assert data == b"s_mm,rho_mm\n0.0,inf\n1.0,inf\n2.0,-3.5\n"
    assert math.isinf(read(data)[1][0][1])


def test_zero_has_no_sign() -> None:
    assert table_bytes({"a": [-0.0]}) == b"a\n0.0\n"


def test_what_is_no_table_is_refused() -> None:
    for name, value in (("b", math.nan), ("b", math.inf), ("rho_mm", math.nan)):
        with pytest.raises(NotFiniteError, match=f"column {name} in row 1 .* {value}"):
            table_bytes({"a": [1.0, 2.0], name: [1.0, value]})
    with pytest.raises(ValueError, match="length"):
        table_bytes({"a": [1.0, 2.0], "b": [1.0]})
    with pytest.raises(ValueError, match="column names"):
        table_bytes({"a,b": [1.0]})


def test_what_is_masked_may_be_anything() -> None:
    """A signalling not-a-number, as memory that nobody has written may hold, does not warn."""
    signal = np.array([0x7FF0000000000001, 0x4059000000000000], dtype=np.uint64).view(float)
    column = np.ma.array(signal, mask=[True, False])
    assert table_bytes({"a": column}) == b"a\n\n100.0\n"
