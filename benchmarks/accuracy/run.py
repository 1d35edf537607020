"""Compare methods and write the tables and figures of benchmarks/results/accuracy.md."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import chain
from pathlib import Path

# for the other benchmarks, and for the boolean sweeps of the tests
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))

from matplotlib import rc_context
from matplotlib.figure import Figure

import cam_profiles
import contacts
import gearcam
import integrals
import solids
import wheels
from gearcam.console import quieten
from gearcam.numeric.arrays import keep_freed_memory
from gearcam.pictures.charts import Chart
from gearcam.results.accuracy import accuracy
from measuring import ROOT, environment
from methods import Found, climb

PAGE = ROOT / "benchmarks" / "results" / "accuracy.md"
FIGURES = ROOT / "benchmarks" / "results" / "accuracy"
BEGIN, END = "<!-- written by make accuracy -->", "<!-- end of what make accuracy writes -->"
COMMANDED = ("ellipse", "plate_cam_offset_roller")
"""Profiles with figures of the command ``gearcam accuracy``."""
REPEATS = 15


def section(found: Found) -> list[str]:
    """Return a case as text: heading, note, figure, table, and the most efficient methods."""
    case = found.case
    over = case.cost.partition(",")[0]
    on = ", then ".join(dict.fromkeys(name for name, _ in found.front))
    return [
        f"### {case.title}",
        "",
        case.note,
        "",
        f"![{case.title}: error against {over}](accuracy/{case.name}.svg)",
        "",
        *found.rows(),
        "",
        f"Not surpassed in error and cost, from fast to accurate: {on}.",
        "",
    ]


def draw(name: str, charts: Sequence[Chart]) -> None:
    """Write charts into one figure, two in a row, with a mark at every level."""
    columns = min(2, len(charts))
    rows = -(-len(charts) // columns)
    figure = Figure((6.0 * columns, 4.0 * rows), layout="constrained")
    for number, chart in enumerate(charts):
        ax = chart.draw(figure.add_subplot(rows, columns, number + 1))
        if not any(line.dots for line in chart.lines):
            for line in ax.lines:
                line.set_marker(".")
        ax.legend(fontsize="small")
    # text as text, and the same file from the same numbers
    with rc_context({"svg.fonttype": "none", "svg.hashsalt": name}):
        figure.savefig(FIGURES / f"{name}.svg", metadata={"Date": None})


def main() -> int:
    """Measure all cases and write figures and page."""
    keep_freed_memory()  # as the command line does
    quieten()
    FIGURES.mkdir(exist_ok=True)
    for name in COMMANDED:
        found = accuracy(
            gearcam.build(gearcam.load(ROOT / "profiles" / f"{name}.toml")), repeat=REPEATS
        )
        draw(name, found.charts)
        print(f"{name}: {', '.join(found.ladders)}", flush=True)
    text, behind = [*environment(), ""], []
    rooms = (integrals, wheels, contacts, cam_profiles, solids)
    for case in chain.from_iterable(room.cases() for room in rooms):
        found = climb(case, REPEATS)
        draw(case.name, [found.chart])
        text += section(found)
        if not found.on_front:
            behind.append(case.title)
        print(f"{case.title}: front {[name for name, _ in found.front]}", flush=True)
    before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    PAGE.write_text("\n".join([before + BEGIN, "", *text, END + after]), encoding="utf-8")
    print(f"wrote {PAGE.relative_to(ROOT)}")
    print(f"cases in which another method is the most accurate: {', '.join(behind) or 'none'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
