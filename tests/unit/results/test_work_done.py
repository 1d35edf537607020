"""Nothing is computed twice: how often what is expensive is called for each output, and why.

Counted are calls of the functions of `WATCHED` and the makings of its properties. A call with the
very same arguments as another one is a fault; a count above one for each thing that is made has its
reason beside it. The command `accuracy` is left out: it repeats, to measure.
"""

from __future__ import annotations

import os
import pkgutil
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cached_property, wraps
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.cli import main
from gearcam.designs.kind import KINDS
from helpers_pairs import PROFILES
from helpers_sampling import few

WATCHED = {
    "gearcam.gears.rolling": ("roll",),
    "gearcam.gears.outline": ("build_outline",),
    "gearcam.gears.contact": ("FlankPairs.arcs",),
    "gearcam.gears.subject": ("CheckedPair.sides",),
    "gearcam.meshing.contact": ("contacts",),
    "gearcam.meshing.edges": ("touches",),
    "gearcam.meshing.patches": ("patches",),
    "gearcam.meshing.half_teeth": ("half_teeth",),
    "gearcam.kinds.gear_pair.shown": ("facts",),
    "gearcam.kinds.cam.shown": ("facts",),
    "gearcam.kinds.gear_pair.tables": ("centrode_columns", "contact_rows"),
    "gearcam.laws.program": ("make_program",),
    "gearcam.cams.measures": ("range_of", "undercut"),
    "gearcam.cams.wall": ("Wall.contour",),
    "gearcam.numeric.sampling": ("Sampler.chords", "Sampler.dense"),
    "gearcam.base.findings": ("run_checks",),
    "gearcam.parts.make": ("make_part",),
    "gearcam.parts.tools": ("tool_limits",),
    "gearcam.parts.mass": ("mass_properties",),
    "gearcam.parts.solids": ("solid",),
    "gearcam.kinds.cam.drawings": ("cam_drawing",),
    "gearcam.kinds.gear_pair.drawings": ("pair_drawing",),
    "gearcam.kinds.gear_pair.sheet": ("pair_sheet",),
    "gearcam.pictures.drawings": ("wheel_drawing",),
    "gearcam.sheets.part": ("part_sheet",),
    "gearcam.export.dxf": ("dxf_bytes",),
    "gearcam.export.dxf_read": ("measure_dxf",),
    "gearcam.export.sheet_dxf": ("sheet_dxf",),
    "gearcam.export.sheet_svg": ("sheet_svg",),
    "gearcam.export.mesh": ("stl_bytes", "threemf_bytes", "glb_bytes", "view_page"),
    "gearcam.export.svg": ("svg_bytes",),
    "gearcam.export.cut_svg": ("cut_svg",),
    "gearcam.report.data": ("scene_data",),
    "gearcam.designs.design": ("hash_of", "summary_of"),
    "shapely": ("union_all", "unary_union", "intersection", "difference"),
}
"""What is expensive, by its home."""


for module in pkgutil.walk_packages(gearcam.__path__, "gearcam."):
    if not module.name.endswith("__main__"):
        import_module(module.name)  # before any name of it is watched


class Work:
    """Calls by name, and which were made with the very same arguments as another one."""

    def __init__(self) -> None:
        self.calls: Counter[str] = Counter()
        self.again: Counter[str] = Counter()
        self._seen: dict[Any, Any] = {}

    def count(self, name: str, *given: Any, **named: Any) -> None:
        """Take in a call."""
        self.calls[name] += 1
        key = (name, *map(_key, given), *((word, _key(one)) for word, one in sorted(named.items())))
        self.again[name] += key in self._seen
        self._seen[key] = given, named  # kept, so that no other object has its identity


def _key(one: Any) -> Any:
    """Equal for arguments that are the same: values by value, arrays by content."""
    if isinstance(one, np.ndarray):
        return one.shape, one.tobytes()
    if isinstance(one, tuple | list):
        return tuple(map(_key, one))
    return one if isinstance(one, str | int | float | complex) else id(one)


@contextmanager
def watched() -> Iterator[Work]:
    """Count the work that is done within."""
    work, patch = Work(), pytest.MonkeyPatch()
    try:
        for home, names in WATCHED.items():
            for name in names:
                _watch(work, patch, home, name)
        yield work
    finally:
        patch.undo()


def _watch(work: Work, patch: pytest.MonkeyPatch, home: str, name: str) -> None:
    owner: Any = import_module(home)
    owners, _, last = name.rpartition(".")
    if owners:
        owner = getattr(owner, owners)
    old = vars(owner)[last]
    if isinstance(old, cached_property):

        def made(this: Any) -> Any:
            work.count(name, this)
            return old.func(this)

        new = cached_property(made)
        new.__set_name__(owner, last)
        patch.setattr(owner, last, new)
        return

    @wraps(old)
    def called(*given: Any, **named: Any) -> Any:
        work.count(name, *given, **named)
        return old(*given, **named)

    patch.setattr(owner, last, called)
    if not owners:  # other modules may have taken it in by its name
        for module in [one for key, one in sys.modules.items() if key.startswith("gearcam")]:
            for word in [key for key, value in vars(module).items() if value is old]:
                patch.setattr(module, word, called)


def _design(name: str, files: tuple[str, ...]) -> Any:
    return gearcam.load(PROFILES / f"{name}.toml").with_({"output.files": list(files)})


def _files(name: str) -> tuple[str, ...]:
    """Every kind of file of a profile's kind; those of STEP take seconds to load their library."""
    known = KINDS[gearcam.load(PROFILES / f"{name}.toml").kind].formats
    return tuple(one for one in known if one != "step")


def build(name: str, folder: Path) -> None:
    """Build every file."""
    files = _files(name)
    gearcam.build(_design(name, files)).write(folder, files)


def check(name: str, folder: Path) -> None:
    gearcam.build(_design(name, ("csv",))).check(folder)


def mesh(name: str, folder: Path) -> None:
    gearcam.build(_design(name, ("csv",))).mesh().write(folder)


def compare(name: str, folder: Path) -> None:
    """Compare two variants."""
    file = str(PROFILES / f"{name}.toml")
    words = ["compare", file, "--set", "output.chord_tolerance_mm=0.001,0.002"]
    assert main([*words, "-o", str(folder)]) == 0


def view(name: str, _: Path) -> None:
    """Show what a save has made."""
    from gearcam.view.work import show

    assert not show((PROFILES / f"{name}.toml").read_bytes(), f"{name}.toml")["error"]


PAIR = {"roll": 1, "facts": 1, "build_outline": 2, "Sampler.chords": 2, "CheckedPair.sides": 1}
SUMMARY = {"hash_of": 1, "summary_of": 1}
BOTH_SIDES = {"FlankPairs.arcs": 2}
CHARTED = {"contacts": 2, "contact_rows": 2, "centrode_columns": 1, "scene_data": 1}
WALL = {"make_program": 1, "facts": 1, "Wall.contour": 1, "undercut": 1}
# pressure angle and curvature of rise and return, and curvature of the whole turn; the radius that
# the warning about the pressure angle names, proven on rise and return of two cams
RANGES = {"range_of": 9}

EXPECTED: dict[tuple[str, Callable[[str, Path], None]], dict[str, int]] = {
    ("ellipse", build): {
        **PAIR, **BOTH_SIDES, **CHARTED, **SUMMARY,
        # the page shows solids with coarser outlines of the same centrodes
        "build_outline": 4, "Sampler.chords": 4, "make_part": 4, "Sampler.dense": 4, "solid": 4,
        # of teeth, and of parts
        "run_checks": 2,
        "tool_limits": 2, "wheel_drawing": 2, "pair_drawing": 1, "part_sheet": 2, "pair_sheet": 1,
        # of both wheels and the pair, of sheets for cutting of both wheels and all
        "dxf_bytes": 3, "measure_dxf": 3, "sheet_dxf": 3, "sheet_svg": 3, "cut_svg": 3,
        "stl_bytes": 3, "threemf_bytes": 3, "glb_bytes": 3, "svg_bytes": 1, "view_page": 1,
    },
    ("ellipse", check): {**PAIR, **BOTH_SIDES, **SUMMARY, "run_checks": 1},
    ("ellipse", mesh): {
        **PAIR, **BOTH_SIDES, **SUMMARY,
        # of the pair, and of the study
        "run_checks": 2,
        # outlines as fine as the overclosure asks for
        "Sampler.chords": 4, "half_teeth": 2,
        # for the largest lever; then three blocks of 120 phases, both sides
        "contacts": 7,
        "intersection": 3, "patches": 3,
    },
    ("ellipse", compare): {
        # two variants, laid over each other in one scene
        **{name: 2 * count for name, count in (PAIR | BOTH_SIDES | CHARTED).items()},
        "run_checks": 2, "make_part": 4, "scene_data": 1,
    },
    ("ellipse", view): {
        **PAIR, **BOTH_SIDES, **CHARTED, "run_checks": 1, "make_part": 2,
        # and for each number, to see whether a design can be made with another value
        "roll": 1 + 5,
    },
    ("plate_cam_offset_roller", build): {
        **WALL, **RANGES, **SUMMARY,
        # of the cam, and of the part
        "run_checks": 2,
        # the page shows the solid with a coarser profile; the pitch curve is drawn too
        "Wall.contour": 2, "make_part": 2, "solid": 2, "Sampler.chords": 3,
        # of both profiles, and of the pitch curve whose curvature is studied
        "undercut": 3,
        # and the dense points of the way of a cutter
        "Sampler.dense": 3,
        "tool_limits": 1, "part_sheet": 1, "scene_data": 1, "view_page": 1,
        # as it is cut, and with its follower
        "cam_drawing": 2,
        # of the cam and the way of a cutter; of the cam and the sheet of all
        "dxf_bytes": 2, "measure_dxf": 2, "cut_svg": 2,
        "sheet_dxf": 1, "sheet_svg": 1, "svg_bytes": 1,
        "stl_bytes": 1, "threemf_bytes": 1, "glb_bytes": 1,
    },
    ("plate_cam_offset_roller", check): {
        **WALL, **RANGES, **SUMMARY, "run_checks": 1, "Sampler.chords": 1,
    },
    ("plate_cam_offset_roller", view): {
        **WALL, **RANGES, "run_checks": 2, "make_part": 1, "tool_limits": 1, "Sampler.dense": 1,
        "Sampler.chords": 2, "cam_drawing": 1, "scene_data": 1,
        "make_program": 1 + 5,  # as of the pair: for each number
    },
    ("groove_cam", check): {
        # both walls, and the pitch curve that the groove is cut along
        **WALL, **RANGES, **SUMMARY, "Wall.contour": 2, "undercut": 2,
        "run_checks": 2, "Sampler.chords": 3, "make_part": 1, "tool_limits": 1,
    },
}  # fmt: skip


@pytest.mark.parametrize(("name", "output"), few(EXPECTED, 4))
def test_nothing_is_computed_twice(
    name: str, output: Callable[[str, Path], None], tmp_path: Path
) -> None:
    with watched() as work:
        output(name, tmp_path)
    assert {one: count for one, count in work.again.items() if count} == {}
    assert dict(work.calls) == EXPECTED[name, output]


def test_a_second_call_is_seen() -> None:
    """The control: what is computed again is counted, and told from the same of another object."""
    design = _design("ellipse", ("csv",))
    with watched() as work:
        first, second = gearcam.build(design), gearcam.build(design)
        assert first.pair
        assert second.pair
        first.contact([0.0])
        first.contact([0.0])
        first.contact([0.1])
    assert (work.calls["roll"], work.calls["contacts"]) == (2, 3)
    assert (work.again["roll"], work.again["contacts"]) == (0, 1)


def test_remedies_are_sought_once_for_the_page_and_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from gearcam.cli import main
    from gearcam.results.advice import Search

    begun, old = [], Search.__init__

    def begin(search: Search, *given: Any) -> None:
        begun.append(given)
        old(search, *given)

    monkeypatch.setattr(Search, "__init__", begin)
    text = (PROFILES / "ellipse.toml").read_text().replace('["csv"]', '["report"]')
    file = tmp_path / "low.toml"
    file.write_text(text + "[rack]\naddendum = 0.5\n")
    assert main(["build", str(file), "-o", str(tmp_path)]) == 1
    assert "pair" in capsys.readouterr().out
    assert len(begun) == 1


@pytest.fixture(scope="module", params=[24, 240])
def ellipse(request: pytest.FixtureRequest) -> Any:
    """A pair of few and of many teeth."""
    files = _design("ellipse", ("csv",))
    return gearcam.build(files.with_({"pair.teeth": [request.param, request.param]}))


def test_contact_is_sought_on_the_teeth_in_mesh_alone(ellipse: Any) -> None:
    """Pairs at a phase: those of a contact ratio below 2 and one to either side, however many."""
    phases = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)
    for pairs in ellipse.subject.sides:
        assert pairs.arcs.ratios.max() < 2.0
        step, _ = pairs.beside(phases)
        assert set(np.bincount(step)) == {5}


def test_outlines_are_overlapped_where_tips_reach_into_the_mate(
    ellipse: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of circles with tips h above the pitch radius R, a chord of about ``4*sqrt(R*h)``.

    As many half-teeth of half a pitch stand on it, and two at either end that reach over it.
    """
    from gearcam.meshing.half_teeth import HalfTeeth
    from gearcam.meshing.study import mount

    setup = mount(ellipse.gears, ellipse.design.meshing)
    asked, old = [], HalfTeeth.placed

    def placed(half: HalfTeeth, which: Any, *pose: Any) -> Any:
        asked.append(len(which))
        return old(half, which, *pose)

    monkeypatch.setattr(HalfTeeth, "placed", placed)
    phases = np.linspace(0.0, 2.0 * np.pi, 120, endpoint=False)
    setup.turning.overlaps(phases, ellipse.design.meshing.overclosure)
    module, teeth = ellipse.pair.module, ellipse.pair.teeth[0]
    chord = 4.0 * np.sqrt(0.5 * module * teeth * module)
    assert 4.0 < sum(asked) / len(phases) < chord / (0.5 * np.pi * module) + 4.0


@pytest.mark.parametrize("chords", [1e-2, 1e-3])
@pytest.mark.parametrize("name", ["ellipse", "plate_cam_offset_roller"])
def test_solids_have_the_vertices_of_the_outlines_and_no_more(name: str, chords: float) -> None:
    """On the lower face, where no mark is, of an edge with no bore."""
    result = gearcam.build(_design(name, ("stl",)).with_({"output.chord_tolerance_mm": chords}))
    for part in result.parts:
        vertices = result.meshes[part.name].vertices
        assert np.count_nonzero(vertices[:, 2] == 0.0) == len(part.contour.vertices)


def test_a_page_shows_solids_of_fewer_vertices(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is drawn on a screen takes the coarser outlines, not those of files."""
    from gearcam.report import file as solids

    shown: dict[str, Any] = {}
    monkeypatch.setattr("gearcam.export.mesh.view_page", lambda bodies: shown.update(bodies) or "")
    result = gearcam.build(_design("ellipse", ("report",)))
    solids.solids_shown(result)
    assert shown.keys() == result.meshes.keys()
    for name, (mesh, _) in shown.items():
        assert 2 * len(mesh.vertices) < len(result.meshes[name].vertices)


@pytest.mark.skipif(sys.platform != "linux", reason="threads are counted where Linux lists them")
@pytest.mark.parametrize(("asked", "threads"), few([({}, 1), ({"OPENBLAS_NUM_THREADS": "2"}, 2)]))
def test_the_command_has_no_threads_for_linear_algebra(asked: dict[str, str], threads: int) -> None:
    """But those that are asked for, and of these at most one for each processor."""
    words = (
        "import os, gearcam.__main__ as command; command.main(); import numpy;"
        "print(len(os.listdir('/proc/self/task')))"
    )
    kept = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    done = subprocess.run(
        [sys.executable, "-c", words, "laws"], env=kept | asked, capture_output=True, check=True
    )
    assert int(done.stdout.split()[-1]) == min(threads, len(os.sched_getaffinity(0)))
