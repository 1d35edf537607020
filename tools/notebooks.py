"""Run the notebooks of docs/notebooks and store their output, for `make notebooks`.

Each runs in an empty folder. Times and execution counts are not stored. The page of a result is
replaced by its picture: pages are large, and do not move where stored notebooks are only read.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from nbclient import NotebookClient

HOME = Path(__file__).resolve().parents[1] / "docs" / "notebooks"
SECONDS = 300
"""Time allowed for a cell on a busy machine."""


def run(path: Path, folder: str | Path) -> nbformat.NotebookNode:
    """Return a notebook with the outputs of a run in a folder."""
    notebook = nbformat.read(path, as_version=4)
    client = NotebookClient(notebook, timeout=SECONDS, resources={"metadata": {"path": folder}})
    made = client.execute()
    for cell in made.cells:
        cell.metadata.pop("execution", None)
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if "<iframe" in data.get("text/html", ""):  # a page is large, and static here
                del data["text/html"]
            elif "text/html" in data:  # contains the picture too
                data.pop("image/svg+xml", None)
    made.metadata.language_info = {"name": "python"}
    return made


if __name__ == "__main__":
    for notebook in sorted(HOME.glob("*.ipynb")):
        with TemporaryDirectory() as folder:
            nbformat.write(run(notebook, folder), notebook)
