"""Compare methods and write the tables and figures of benchmarks/results/accuracy.md."""

from __future__ import annotations

import sys
from itertools import chain
from pathlib import Path

# for the other benchmarks, and for the boolean sweeps of the tests
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))

import cam_profiles
import contacts
import gearcam
import integrals
import solids
import wheels
from gearcam.console import quieten
from gearcam.numeric.arrays import keep_freed_memory
from gearcam.results.accuracy import accuracy
from gearcam.results.accuracy_svg import log_charts
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


def main() -> int:
    """Measure all cases and write figures and page."""
    keep_freed_memory()  # as the command line does
    quieten()
    FIGURES.mkdir(exist_ok=True)
    for name in COMMANDED:
        found = accuracy(
            gearcam.build(gearcam.load(ROOT / "profiles" / f"{name}.toml")), repeat=REPEATS
        )
        picture = log_charts(f"{name}: error against run time", found.charts)
        (FIGURES / f"{name}.svg").write_bytes(picture)
        print(f"{name}: {', '.join(found.ladders)}", flush=True)
    text, behind = [*environment(), ""], []
    rooms = (integrals, wheels, contacts, cam_profiles, solids)
    for case in chain.from_iterable(room.cases() for room in rooms):
        found = climb(case, REPEATS)
        (FIGURES / f"{case.name}.svg").write_bytes(log_charts(case.title, [found.chart]))
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
