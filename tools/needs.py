"""Measures what each output computes and imports, in separate processes.

It writes the table in benchmarks/results/performance.md; `make bench` writes the whole page. A test
compares the table with new measurements. An *output* is a kind of file or a command, for one small
design of each kind.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
PAGE: Final = ROOT / "benchmarks" / "results" / "performance.md"
BEGIN: Final = "<!-- what each output needs: written by tools/needs.py -->"
END: Final = "<!-- end of what each output needs -->"

PACKAGES: Final = (
    "numpy", "shapely", "ezdxf", "reportlab", "manifold3d", "trimesh", "networkx", "lxml", "jinja2",
    "rich", "OCP", "matplotlib", "optuna", "distributed", "pyarrow", "skfem",
)  # fmt: skip
"""Packages that the program may import."""

DESIGNS: Final = {"gear-pair": "ellipse", "cam": "plate_cam_offset_roller"}
"""A profile of each kind without hubs or openings."""

COMMANDS: Final = {
    "check": ("check", "{file}"),
    "mesh": ("mesh", "{file}"),
    "follow": ("follow", "{file}", "{folder}/profile.csv"),
    "accuracy": ("accuracy", "{file}", "--repeat", "1"),
    "compare": ("compare", "{file}", "--set", "output.chord_tolerance_mm=0.001,0.002"),
    "view": ("view", "{file}"),
}
"""Outputs that are commands, with their arguments; of ``view`` the update after a save."""

ONLY: Final = {"mesh": "gear-pair", "follow": "cam"}
"""Commands for one kind of design."""

STUDIES: Final = ("meshing", "follow")
"""Stages of a result that are not properties of it."""

REPEATS: Final = 3
"""Number of processes; the median is taken."""

HEAD: Final = "## What each output needs\n"

ABOUT: Final = """\
Each row is a process that makes this output only, for the profile `ellipse`, 41 : 41 teeth, or
`plate_cam_offset_roller`. Processor time, with the start of Python, and peak memory are those of
the median of {repeats} processes; `python -c "import numpy, shapely"` takes {seconds} and {memory}.
Stages are the properties of a result that were computed, each once, in order; other results belong
to designs that are compared or refined, or shown with coarser outlines. Modules of gearcam are
those in addition to a build of `csv`, which for both kinds loads {rooms}."""

COLUMNS: Final = (
    "| kind | output | stages | packages | more modules | time | peak memory |",
    "|---|---|---|---|---|---|---|",
)

CHILD: Final = '''
import contextlib, io, json, resource, sys, time
from functools import cached_property

def kept():
    """Return the peak memory of this process, bytes."""
    with contextlib.suppress(OSError), open("/proc/self/status") as told:
        return 1024 * int(next(line.split()[1] for line in told if line.startswith("VmHWM")))
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most if sys.platform == "darwin" else 1024 * most

def run(words):
    if words[0] == "view":
        from gearcam.view.work import show
        reply = show(None, words[1])
        assert not reply["error"], reply
        return
    from gearcam.cli import main
    with contextlib.redirect_stdout(io.StringIO()) as said:
        code = main([*words, "-o", sys.argv[1]])
    assert code == 0, (words, said.getvalue())

def stages(made, studies):
    result, *others = made
    done = [
        name for name in vars(result)
        if isinstance(getattr(type(result), name, None), cached_property)
    ]
    done += [name for name in studies if name in result.timings]
    return [*done, f"other results: {len(others)}"] if others else done

def room(parts):
    """Return the package of a module, or its own name where outputs need some of a package only."""
    if parts[1] in ("results", "pictures"):
        return parts[2] if parts[2:] else ""
    return "solids" if parts[1:] == ["parts", "solids"] else parts[1]

def main():
    asked, packages, studies = (json.loads(text) for text in sys.argv[2:])
    made = []
    if asked:
        from gearcam.results.result import Result
        begun = Result.__init__
        def begin(result, *given, **named):
            begun(result, *given, **named)
            made.append(result)
        Result.__init__ = begin
    else:
        import numpy, shapely
    for words in asked or [()]:
        made.clear()
        if words:
            run(words)
        loaded = [name.split(".") for name in sys.modules]
        print(json.dumps({
            "stages": stages(made, studies) if made else [],
            "packages": [name for name in packages if [name] in loaded],
            "rooms": sorted(
                {room(parts) for parts in loaded if parts[0] == "gearcam" and parts[1:]} - {""}
            ),
            "seconds": time.process_time(),
            "memory": kept(),
        }), flush=True)

main()
'''


@dataclass(frozen=True, kw_only=True)
class Needs:
    """What was computed and imported for an output.

    Parameters
    ----------
    stages : tuple of str
        Properties of the result that were computed.
    packages, rooms : frozenset of str
        Loaded packages of `PACKAGES`, and loaded modules of gearcam.
    seconds : float
        Processor time of the process.
    memory : float, bytes
        Peak memory of the process.
    """

    stages: tuple[str, ...]
    packages: frozenset[str]
    rooms: frozenset[str]
    seconds: float
    memory: float


def outputs(kind: str) -> tuple[str, ...]:
    """Return the outputs of a `kind` of design; ``follow`` reads a file of ``csv``."""
    from gearcam.designs.kind import KINDS

    commands = [name for name in COMMANDS if ONLY.get(name, kind) == kind]
    files = [name for name in KINDS[kind].formats if name != "csv"]
    return "csv", *commands, *files


def needs(kind: str, asked: Sequence[str]) -> Iterator[Needs]:
    """Yield what is loaded after each output, when all are made in one process.

    Parameters
    ----------
    kind : str
        The kind of design.
    asked : sequence of str
        Outputs; none: only numpy and shapely are imported.
    """
    with tempfile.TemporaryDirectory() as folder:
        words = [_words(kind, output, Path(folder)) for output in asked]
        if list(asked[:1]) == ["follow"]:
            _child(folder, [_words(kind, "csv", Path(folder))])
        yield from _child(folder, words)


def _words(kind: str, output: str, folder: Path) -> list[str]:
    """Write the design for an output and return the arguments of the command line."""
    name = DESIGNS[kind]
    text = (ROOT / "profiles" / f"{name}.toml").read_text(encoding="utf-8")
    wanted = "csv" if output in COMMANDS else output
    file = folder / f"{output}.toml"
    file.write_text(re.sub(r"files = \[.*\]", f'files = ["{wanted}"]', text), encoding="utf-8")
    words = COMMANDS.get(output, ("build", "{file}"))
    return [word.format(file=file, folder=folder / name) for word in words]


def _child(folder: str, asked: Sequence[Sequence[str]]) -> list[Needs]:
    told = [json.dumps(part) for part in (asked, PACKAGES, STUDIES)]
    done = subprocess.run(
        [sys.executable, "-c", CHILD, folder, *told],
        cwd=ROOT,
        check=False,
        capture_output=True,
        text=True,
    )
    if done.returncode:
        raise RuntimeError(done.stderr)
    return [_read(json.loads(line)) for line in done.stdout.splitlines()]


def _read(row: Mapping[str, Any]) -> Needs:
    return Needs(
        stages=tuple(row["stages"]),
        packages=frozenset(row["packages"]),
        rooms=frozenset(row["rooms"]),
        seconds=row["seconds"],
        memory=row["memory"],
    )


def texts(found: Needs, usual: Iterable[str]) -> tuple[str, str, str]:
    """Return stages, packages, and modules beyond the `usual` ones, as cells of the table."""
    packages = [name for name in PACKAGES if name in found.packages]
    return tuple(
        ", ".join(each) for each in (found.stages, packages, sorted(found.rooms - set(usual)))
    )  # pyright: ignore[reportReturnType]


def section() -> str:
    """Measure, and return the section of the page."""
    bare = _median([next(iter(needs("cam", ()))) for _ in range(REPEATS)])
    rows, shared = [], None
    for kind in DESIGNS:
        usual: frozenset[str] = frozenset()
        for output in outputs(kind):
            found = _median([next(iter(needs(kind, [output]))) for _ in range(REPEATS)])
            usual = found.rooms if output == "csv" else usual
            cells = [kind, output, *texts(found, usual), _seconds(found), _memory(found)]
            rows.append(f"| {' | '.join(cells)} |")
            print(rows[-1], flush=True)
        shared = usual if shared is None else shared & usual
    about = ABOUT.format(
        repeats=REPEATS,
        seconds=_seconds(bare),
        memory=_memory(bare),
        rooms=", ".join(sorted(shared or ())),
    )
    return "\n".join([BEGIN, HEAD, textwrap.fill(about, 100), "", *COLUMNS, *rows, END, ""])


def _median(found: Sequence[Needs]) -> Needs:
    return sorted(found, key=lambda one: one.seconds)[len(found) // 2]


def _seconds(found: Needs) -> str:
    return f"{found.seconds:.2f} s"


def _memory(found: Needs) -> str:
    return f"{found.memory / 2**20:.0f} MiB"


def table(page: str) -> dict[tuple[str, str], tuple[str, str, str]]:
    """Return stages, packages and modules in the table of a `page`, by kind and output."""
    body = page.partition(BEGIN)[2].partition(END)[0]
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in body.splitlines()
        if line.startswith("| ")
    ]
    return {(row[0], row[1]): (row[2], row[3], row[4]) for row in rows[1:]}


def write(page: str) -> None:
    """Write a `page` with a new section, instead of the present one or at the end."""
    before, _, rest = page.partition(BEGIN)
    after = rest.partition(END)[2].lstrip("\n")
    made = f"{before.rstrip()}\n\n{section()}" + (f"\n{after}" if after else "")
    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(made, encoding="utf-8")
    print(f"wrote {PAGE.relative_to(ROOT)}")


if __name__ == "__main__":
    write(PAGE.read_text(encoding="utf-8"))
