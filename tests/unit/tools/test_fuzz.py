"""The fuzzer sees what is planted, makes it small, and finds nothing where nothing is wrong."""

from __future__ import annotations

import dataclasses
import tomllib
from collections import Counter
from functools import cache, partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import gearcam
import helpers_processes
from fuzz import cross_checks_pair as of_pair
from fuzz import oracles, trial
from fuzz.campaign import Campaign, Case
from fuzz.command import main
from fuzz.cross_checks_cam import doubts as doubts_of_cam
from fuzz.outcome import BUILT, REFUSED, WRONG, Outcome, Task
from fuzz.pool import Pool
from fuzz.shrink import shrunk
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.designs.outputs import MESHES
from gearcam.meshing.settings import MeshingSpec
from gearcam.results.advice import Remedies, Remedy
from helpers_pairs import PROFILES
from random_designs.designs import MAKERS, design
from random_designs.documented import places as places_in

SMALL = """kind = "gear-pair"
name = "small"

[law]
type = "ellipse"
eccentricity = 0.1

[pair]
module_mm = 2
teeth = [16, 16]

[output]
files = ["csv", "stl", "svg"]
"""


# --- processes ----------------------------------------------------------------------------------


def test_whatever_happens_in_a_process_every_task_has_its_outcome() -> None:
    words = ["one", "run for ever", "die", "eat", "sleep", "two"]
    tasks = [(number, Task(files={"a.toml": word})) for number, word in enumerate(words)]
    with Pool(helpers_processes.odd, processes=1, seconds=0.3) as pool:
        ends = dict(pool.each(tasks))
    failures = [ends[number].failure for number in range(len(words))]
    assert [one and one.kind for one in failures] == [None, "time", "crash", "memory", "time", None]
    assert ends[2].failure is not None
    assert "ended twice" in ends[2].failure.words
    assert (ends[0].reason, ends[5].reason) == ("one", "two")


# --- one trial ----------------------------------------------------------------------------------


def tried(folder: Path, text: str = SMALL, **asked: bool) -> Outcome:
    return trial.tried(Task(files={"small.toml": text}, **asked), folder)


def test_ends_are_told_from_each_other(tmp_path: Path) -> None:
    texts = {
        BUILT: SMALL,
        REFUSED: SMALL.replace('"svg"]', '"svg"]\nphi1_deg = -250').replace(
            'type = "ellipse"\neccentricity = 0.1',
            'type = "log-spiral"\nratios = [2.2, 0.8]\ndriven_travel_deg = 210',
        ),
        WRONG: SMALL.replace("0.1", "-1"),
    }
    for end, text in texts.items():
        folder = tmp_path / end
        folder.mkdir()
        made = tried(folder, text, doubt=True, follow=True)
        assert (made.end, made.failure, made.doubted) == (end, None, end == BUILT)
        assert bool(made.reason) == (end != BUILT)
        assert bool(made.followed) == (end == REFUSED)


@pytest.mark.parametrize("error", [KeyError("x"), MemoryError(), ZeroDivisionError()])
def test_what_is_raised_is_a_failure_with_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def broken(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("gearcam.gears.pair.build_outline", broken)
    found = tried(tmp_path).failure
    assert found is not None
    assert found.kind == ("memory" if isinstance(error, MemoryError) else "crash")
    assert found.place == f"{type(error).__name__} in pair.py, make_gear"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"law.eccentricity": 0.9}, "it should be built"),
        ({"rack.addendum": 0.3, "rack.dedendum": 0.5}, "it should have no error"),
    ],
)
def test_a_remedy_that_does_not_help_is_a_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, changes: dict[str, Any], words: str
) -> None:
    def promised(result: Any, *_: object, **__: object) -> Remedies:
        return Remedies(found=(Remedy(changes=changes, design=result.design.with_(changes)),))

    monkeypatch.setattr(trial, "remedies", promised)
    found = tried(tmp_path, SMALL.replace("0.1", "0.95"), follow=True).failure
    assert found is not None
    assert found.kind == "remedy"
    assert words in found.words


# --- oracles ------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("small")
    (folder / "small.toml").write_text(SMALL)
    result = gearcam.build(gearcam.load(folder / "small.toml"))
    formats = ["csv", *MESHES, "svg", "dxf"]
    return SimpleNamespace(result=result, written=result.write(folder, files=formats))


def test_nothing_is_wrong_with_a_good_result(small: Any) -> None:
    assert [*oracles.look_at(small.result, small.written)] == []


def test_polygons_that_cross_themselves_are_seen(small: Any) -> None:
    part = small.result.parts[0]
    contour = part.contour
    crossed = contour.points.copy()
    crossed[[3, 4]] = crossed[[4, 3]]
    wrong = dataclasses.replace(contour, points=crossed)
    parts = (dataclasses.replace(part, contours=(wrong,)),)
    written = dataclasses.replace(small.written, files=(), summary={})
    (found,) = oracles.look_at(SimpleNamespace(parts=parts), written)
    assert found.kind == "polygon"
    assert "Self-intersection" in found.words


def test_parts_that_cannot_be_made_are_no_failure_where_no_file_asks_for_them(small: Any) -> None:
    class Refused:
        @property
        def parts(self) -> None:
            raise InfeasibleError("no room", where="blank", value=1.0, limit=0.0)

    written = dataclasses.replace(small.written, files=(), summary={})
    assert [*oracles.look_at(Refused(), written)] == []


@pytest.mark.parametrize(("share", "places"), [(0.09, []), (0.11, ["torn"])])
def test_curves_that_do_not_join_are_seen(small: Any, share: float, places: list[str]) -> None:
    part = small.result.parts[0]
    first, *others = part.contour.runs
    off = share * part.tolerance
    moved = dataclasses.replace(first, points=first.points + off)
    wrong = dataclasses.replace(part.contour, dense=lambda: (moved, *others))
    parts = (dataclasses.replace(part, contours=(wrong,)),)
    written = dataclasses.replace(small.written, files=(), summary={})
    found = oracles.look_at(SimpleNamespace(parts=parts), written)
    assert [one.place for one in found] == places


SPOILT = {
    "gear1.stl": lambda data: data[:80] + (len(data) // 50 - 2).to_bytes(4, "little") + data[134:],
    "gear1.dxf": lambda data: data[: len(data) // 2],
    "pair.svg": lambda data: data[:-3],
    "centrodes.csv": lambda data: data + b"1,2\n",
    "gear1_outline.csv": lambda data: data + b"nan,nan\n",
    "summary.json": lambda data: data.replace(b"{", b"{\"x\": NaN, ", 1),
}  # fmt: skip


@pytest.mark.parametrize("name", SPOILT)
def test_spoilt_files_are_seen(small: Any, name: str) -> None:
    path = small.written.directory / name
    data = path.read_bytes()
    path.write_bytes(SPOILT[name](data))
    written = dataclasses.replace(small.written, files=(name,), summary={})
    found = [*oracles.look_at(SimpleNamespace(parts=()), written)]
    path.write_bytes(data)
    assert [(one.kind, one.words.partition(":")[0]) for one in found] == [("file", name)]


def test_drawings_farther_off_than_their_tolerance_are_seen(small: Any) -> None:
    tolerance = max(part.tolerance for part in small.result.parts)
    for off, places in ((0.999 * tolerance, []), (1.001 * tolerance, ["dxf error"])):
        summary = {"accuracy": {"dxf_mm": {"a.dxf": 1e-9, "b.dxf": off}}}
        written = dataclasses.replace(small.written, files=(), summary=summary)
        assert [one.place for one in oracles.look_at(small.result, written)] == places


# --- doubts -------------------------------------------------------------------------------------


def test_a_study_contradicts_a_pair_that_is_too_near(
    small: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert [*of_pair.doubts(small.result)] == []
    near = partial(MeshingSpec, center_distance=0.99 * small.result.pair.shift)
    monkeypatch.setattr(of_pair, "MeshingSpec", near)
    assert [place for place, _ in of_pair.doubts(small.result)] == ["interference"]


def test_a_study_contradicts_a_better_contact_ratio(
    small: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    better = small.result.contact_ratio + 1e-3
    monkeypatch.setitem(vars(small.result), "contact_ratio", better)
    assert [place for place, _ in of_pair.doubts(small.result)] == ["contact-ratio"]


@pytest.mark.parametrize(
    "name", ["eccentric_cam", "flat_follower", "valve_lever", "groove_cam", "translating_cam"]
)
def test_a_follower_contradicts_a_profile_that_is_off(name: str) -> None:
    result: Any = gearcam.build(gearcam.load(PROFILES / f"{name}.toml"))
    assert [*doubts_of_cam(result)] == []
    moved = 6.0 * result.profile.tolerance * 1j
    vars(result)["profiles"] = tuple(
        dataclasses.replace(one, points=one.points + moved) for one in result.profiles
    )
    assert {place for place, _ in doubts_of_cam(result)} == {"lift"}


@pytest.mark.parametrize("name", ["flat_follower", "valve_lever", "conjugate_cams"])
def test_an_error_of_the_profile_is_said_in_two_forms(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    result: Any = gearcam.build(gearcam.load(PROFILES / f"{name}.toml"))
    assert [*doubts_of_cam(result)] == []

    def twice(self: Any, *contact: Any) -> Any:
        by_position, by_size = along(self, *contact)
        return 2.0 * by_position, by_size

    face = type(result.follower)
    along = face.along_normal
    monkeypatch.setattr(face, "along_normal", twice)
    assert {place for place, _ in doubts_of_cam(result)} == {"precision"}


def test_a_library_that_a_study_misses_is_a_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise ModuleNotFoundError("x")

    monkeypatch.setattr(of_pair, "study", broken)
    failure = tried(tmp_path, doubt=True).failure
    assert failure is not None
    assert failure.place == "ModuleNotFoundError in cross_checks_pair.py, doubts"


# --- designs ------------------------------------------------------------------------------------


drawn_of = cache(design)


@pytest.mark.parametrize("number", [150, pytest.param(600, marks=pytest.mark.slow)])
def test_whatever_is_broken_is_read_or_refused_in_words(number: int, tmp_path: Path) -> None:
    seen: Counter[str] = Counter()
    refusals: list[DesignError] = []
    for kind in MAKERS:
        for index in range(number):
            drawn = drawn_of(kind, 5, index)
            if not drawn.broken:
                continue
            seen[drawn.broken] += 1
            try:
                gearcam.load(drawn.write(tmp_path))
            except DesignError as error:
                refusals.append(error)
    assert len(seen) == 10
    assert len(refusals) > sum(seen.values()) / 3
    assert all(one.message for error in refusals for one in error.problems)


def test_a_tenth_is_broken() -> None:
    broken = [drawn_of(kind, 5, index).broken for kind in MAKERS for index in range(150)]
    assert 0.08 < sum(map(bool, broken)) / len(broken) < 0.12


# --- small designs ------------------------------------------------------------------------------


def test_a_failing_design_is_made_as_small_as_it_can_be() -> None:
    text = SMALL.replace("0.1", "0.123456") + "\n[limits]\ntip_land = 0.2\n"

    def fails(files: Any) -> bool:
        try:
            found = tomllib.loads(files["small.toml"])
        except ValueError:
            return False
        return found.get("law", {}).get("eccentricity", 0) > 0.12

    assert shrunk({"small.toml": text}, fails, 60.0) == {
        "small.toml": 'kind = "gear-pair"\nname = "small"\n\n[law]\neccentricity = 0.123\n'
    }


def test_a_text_that_is_no_toml_is_made_small() -> None:
    text = "\n".join([*"abcdef", "[x", *"ghijk"])
    files = {"a.toml": text, "b.csv": "1"}
    made = shrunk(files, lambda found: "[x" in found["a.toml"], 60.0)
    assert made == {"a.toml": "[x\n"}


# --- campaigns ----------------------------------------------------------------------------------


def test_a_failure_is_told_made_small_saved_and_reproduced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("fuzz.command.tried", helpers_processes.dislikes_cycloids)
    words = ["--kind", "cam", "--jobs", "1", "-o", str(tmp_path)]
    assert main([*words, "--count", "30"]) == 1
    out, err = capsys.readouterr()
    assert "crash: no way" in err
    first = min(tmp_path.glob("*.toml"), key=lambda path: int(path.stem.rpartition("-")[2]))
    text = first.read_text()
    assert text.startswith("# crash: no way with")
    number = first.stem.rpartition("-")[2]
    assert f"# make fuzz MORE='--kind cam --seed 1 --only {number}'\n" in text
    assert "cycloidal" in tomllib.loads(text)["motion"][0].values()
    assert len(tomllib.loads(text)) == 3
    assert "crash x" in out
    assert main([*words, "--only", number]) == 1
    assert main([*words, "--only", "1"]) == (first.stem == "cam-1-1")


def test_what_takes_too_long_is_tried_once_more() -> None:
    """A machine that pauses is no fault of the program."""
    with Pool(helpers_processes.late_at_first, processes=1, seconds=0.2) as pool:
        campaign = Campaign(cases=[Case(kind="cam", seed=1, index=0)], pool=pool)
        assert [*campaign.run(None)] == []
    assert sum(campaign.counts.values()) == 1
    assert campaign.good


def test_too_many_refusals_are_no_good_end() -> None:
    cases = [Case(kind="cam", seed=1, index=index) for index in range(20)]
    whole = [case for case in cases if not case.drawn.broken]

    def ended(refused: int) -> Campaign:
        campaign = Campaign(cases=cases, pool=SimpleNamespace())  # type: ignore[arg-type]
        for number, case in enumerate(whole):
            end = REFUSED if number < refused else BUILT
            campaign._take(case, Outcome(end=end, reason="no room"))
        return campaign

    few = len(whole) // 5
    assert ended(few).good
    assert not ended(few + 1).good
    assert f"{few + 1:>6}  no room" in "\n".join(ended(few + 1).lines())


def test_broken_designs_do_not_count_among_the_refused() -> None:
    indices = [index for index in range(100) if design("cam", 1, index).broken]
    cases = [Case(kind="cam", seed=1, index=index) for index in indices]
    campaign = Campaign(cases=cases, pool=SimpleNamespace())  # type: ignore[arg-type]
    for case in cases:
        campaign._take(case, Outcome(end=WRONG, reason="x"))
    assert campaign.good


@pytest.mark.parametrize(
    ("words", "told"),
    [(["--kind", "camm"], "invalid choice: 'camm'"), (["--count", "0"], "--count"),
     (["--jobs", "0"], "--jobs")],
)  # fmt: skip
def test_what_cannot_be_asked_is_refused(
    words: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(words)
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        ["--count", "2", "--seed", "7", "--jobs", "1"],
        pytest.param(["--quick", "--jobs", "2"], marks=pytest.mark.slow),
    ],
)
def test_a_campaign_finds_nothing(
    words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*words, "-o", str(tmp_path)]) == 0
    assert "failures: 0" in capsys.readouterr().out


@pytest.mark.parametrize("path", sorted(PROFILES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_key_has_a_range_to_draw_from(path: Path) -> None:
    """Rules between keys, which are in the schema too, are no keys."""
    nodes = [node for *_, node in places_in(tomllib.loads(path.read_text("utf-8")))]
    assert len(nodes) > 10
    assert all({"type", "enum", "anyOf", "const"} & node.keys() for node in nodes)
