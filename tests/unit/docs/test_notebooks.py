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
    names = ["elliptical_pair", "measured_cam", "published_numbers"]
    assert [path.stem for path in STORED] == names


@pytest.mark.parametrize("name", ["measured_cam", "published_numbers"])
def test_cells_print_and_draw_what_is_stored(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The quicker ones in this process, without a kernel; the slow test runs all of them."""
    (path,) = (one for one in STORED if one.stem == name)
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


def test_published_numbers_agree_and_stand_beside_their_sources() -> None:
    (path,) = (one for one in STORED if one.stem == "published_numbers")
    notebook = nbformat.read(path, as_version=4)
    *agreeing, slips = printed(notebook)
    rows = "".join(agreeing).splitlines()
    assert rows[-1] == f"{len(rows) - 1} of {len(rows) - 1} numbers agree"
    assert not [row for row in rows if "does not agree" in row]
    assert slips.count("does not agree") == 2
    sources = {row[59:].strip() for row in rows[:-1]}
    cams = {one for one in sources if one.startswith(("Duca, fig. 3", "Khurmi"))}
    assert len(cams) >= 5
    assert "Litvin, Fuentes, ch. 12" in sources
    assert {"Table 2.7", "Table 3.1", "(2.22)"} <= sources
    told = "".join(cell.source for cell in notebook.cells)
    for author in ("Litvin", "Niculescu", "Duca", "Khurmi"):
        assert author in told


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
