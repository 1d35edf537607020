"""The notebooks run, print what is stored in them, and show their pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import nbformat
import pytest
from nbclient.exceptions import CellExecutionError

import notebooks

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


def test_cells_print_and_draw_what_is_stored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The quickest of them in this process, without a kernel; the slow test runs all of them."""
    (path,) = (one for one in STORED if one.stem == "measured_cam")
    stored = nbformat.read(path, as_version=4)
    monkeypatch.chdir(tmp_path)
    plt.switch_backend("agg")
    plt.close("all")  # what other tests of this process have left open
    names: dict[str, Any] = {}
    told = []
    for cell in stored.cells:
        if cell.cell_type == "code":
            exec(cell.source, names)
            told.append(capsys.readouterr().out)
    kinds = [kind for cell in shown(stored) for kind in cell]
    assert [text for text in told if text] == printed(stored)
    assert len(plt.get_fignums()) == kinds.count("image/png")
    plt.close("all")


@pytest.mark.slow
@pytest.mark.parametrize("path", STORED, ids=lambda path: path.stem)
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
