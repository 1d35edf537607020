"""The notebooks run, print what is stored in them, and show their pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient.exceptions import CellExecutionError

import notebooks
from helpers_sampling import few

STORED = sorted(notebooks.HOME.glob("*.ipynb"))
LARGEST = 300_000
"""Bytes of a notebook, so that pages show it at once."""


def printed(notebook: Any) -> list[str]:
    texts = [
        "".join(one.text for one in cell.get("outputs", ()) if one.output_type == "stream")
        for cell in notebook.cells
    ]
    return [text for text in texts if text]  # of a cell, however many pieces it came in


def shown(notebook: Any) -> list[list[str]]:
    """Kinds of what is shown, by cell."""
    return [
        sorted(kind for one in cell.get("outputs", ()) for kind in one.get("data", ()))
        for cell in notebook.cells
    ]


def test_there_are_notebooks() -> None:
    assert [path.stem for path in STORED] == ["elliptical_pair", "measured_cam"]


@pytest.mark.parametrize("path", few(STORED), ids=lambda path: path.stem)
def test_a_notebook_does_what_is_stored(path: Path, tmp_path: Path) -> None:
    stored = nbformat.read(path, as_version=4)
    made = notebooks.run(path, tmp_path)
    assert printed(made) == printed(stored)
    assert shown(made) == shown(stored)
    kinds = [kind for cell in shown(stored) for kind in cell]
    assert kinds.count("image/png") >= 2
    assert "image/svg+xml" in kinds  # of a result, which shows its page where it is run
    assert len(printed(stored)) >= 4


@pytest.mark.parametrize("path", STORED, ids=lambda path: path.stem)
def test_what_is_stored_is_small_and_of_no_machine(path: Path) -> None:
    text = path.read_text("utf-8")
    assert len(text.encode()) < LARGEST
    assert not [word for word in (" at 0x", "/home/", "/tmp/", "iopub", '"stderr"') if word in text]


@pytest.mark.slow
def test_a_failing_cell_is_seen(tmp_path: Path) -> None:
    cell = nbformat.v4.new_code_cell("import gearcam as gc\ngc.Gearpair")
    nbformat.write(nbformat.v4.new_notebook(cells=[cell]), tmp_path / "wrong.ipynb")
    with pytest.raises(CellExecutionError, match="gearcam has no Gearpair"):
        notebooks.run(tmp_path / "wrong.ipynb", tmp_path)
