"""Designs nested in another, in its file or by a file's name: read, refused, written, hashed."""

from __future__ import annotations

import math
import pickle
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

import gearcam
from gearcam import designs, kinds
from gearcam.base.errors import DesignError
from gearcam.designs import KINDS
from gearcam.designs.schema import schema
from gearcam.designs.template import template
from gearcam.view.numbers import numbers, sliders
from gearcam.view.watch import Watch, tables

gc: Any = gearcam
loads: Any = designs.loads
"""Toy designs have fields that no type checker knows."""

TOYS = Path(__file__).parents[2] / "toy_kinds"
PAIR = """kind = "gear-pair"
name = "wheels"
[law]
type = "ellipse"
eccentricity = 0.3
[pair]
teeth = [32, 32]
module_mm = 2
"""
TABLES = (
    PAIR.split("\n", 2)[2]
    .replace("[law]", "[drive.pair.law]")
    .replace("[pair]", "[drive.pair.pair]")
)
REST = "[crank]\nlength_mm = 20\n[rod]\nlength_mm = 70\n"
INLINE = f'kind = "slider-crank"\nname = "outer"\n{REST}[drive.pair]\nname = "wheels"\n{TABLES}'
BY_FILE = f'kind = "slider-crank"\nname = "outer"\n[drive]\npair = "sub/pair.toml"\n{REST}'


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A folder with a pair and a slider-crank behind it, while the toy kinds are there."""
    monkeypatch.setattr(kinds, "__path__", [*kinds.__path__, str(TOYS)])
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in" / "sub").mkdir(parents=True)
    (tmp_path / "in" / "sub" / "pair.toml").write_text(PAIR)
    (tmp_path / "in" / "outer.toml").write_text(BY_FILE)
    return tmp_path


def problems(text: str, file: str = "in/outer.toml") -> list[str]:
    """What is refused in a text, each problem with its place and message in one line."""
    with pytest.raises(DesignError) as caught:
        loads(text, file=file)
    return [str(one).split("\n")[0] for one in caught.value.problems]


def test_a_file_and_tables_make_the_same_design() -> None:
    by_file, inline = gc.load("in/outer.toml"), loads(INLINE)
    assert by_file.drive.pair == gc.load("in/sub/pair.toml") == inline.drive.pair
    assert by_file == inline
    assert designs.hash_of(by_file) == designs.hash_of(inline)
    assert Path(by_file.drive.pair.source) == Path("in/sub/pair.toml")


def test_the_name_of_a_design_in_place_is_that_of_its_key() -> None:
    assert loads(INLINE.replace('name = "wheels"\n', "")).drive.pair.name == "pair"


def test_a_design_is_written_in_place_and_read_again() -> None:
    design = gc.load("in/outer.toml")
    document = design.to_dict()
    assert document["drive"]["pair"] == gc.load("in/sub/pair.toml").to_dict()
    assert "cam" not in document["drive"]
    assert gc.design(document) == design
    assert pickle.loads(pickle.dumps(design)) == design


def test_one_value_of_a_nested_design_changes() -> None:
    design = gc.load("in/outer.toml")
    other = design.with_({"drive.pair.law.eccentricity": 0.2})
    assert other.drive.pair.law.eccentricity == 0.2
    assert design.drive.pair.law.eccentricity == 0.3
    assert other != design
    assert designs.hash_of(other) != designs.hash_of(design)
    whole = design.with_({"drive.pair": "in/sub/pair.toml"})  # relative to the current folder
    assert whole == design == design.with_({"drive.pair": gc.load("in/sub/pair.toml")})
    with pytest.raises(DesignError, match=r"drive\.pair\.law\.eccentricity: 2 is out of range"):
        design.with_({"drive.pair.law.eccentricity": 2})


def test_the_hash_leaves_out_what_changes_no_file() -> None:
    design = loads(INLINE)
    same = design.with_({"drive.pair.output.files": ["dxf"], "drive.pair.limits": {}})
    assert designs.hash_of(same) == designs.hash_of(design)


def test_a_nested_design_has_the_type_and_the_kind_of_its_field() -> None:
    design = loads(INLINE)
    spec, crank, rod = type(design.drive), design.crank, design.rod
    made = type(design)(name="outer", drive=spec(pair=design.drive.pair), crank=crank, rod=rod)
    assert made == design
    cam = gc.load(TOYS.parents[1] / "profiles" / "eccentric_cam.toml")
    with pytest.raises(DesignError, match=r'drive\.pair: <CamDesign .*> is of kind "cam"'):
        design.with_({"drive.pair": cam})
    with pytest.raises(DesignError, match=r'drive\.pair\.kind: "cam" does not belong here'):
        type(design)(name="outer", drive=spec(pair=cam), crank=crank, rod=rod)
    with pytest.raises(DesignError, match=r"drive\.pair: is a str\n.*an instance of Design"):
        type(design)(name="outer", drive=spec(pair="in/sub/pair.toml"), crank=crank, rod=rod)


def test_a_function_in_a_nested_design_is_kept() -> None:
    law = gc.laws.Formula(ratio=_ratio)
    pair = gc.GearPairDesign(name="f", law=law, pair=gc.PairSpec(teeth=(32, 32), module=2.0))
    design = loads(INLINE).with_({"drive.pair": pair})
    assert designs.hash_of(design) == designs.hash_of(pickle.loads(pickle.dumps(design)))
    with pytest.raises(DesignError, match=r"drive\.pair\.law\.\w+: the Python function"):
        design.to_dict()


def _ratio(phi: float) -> float:
    return 1.0 + 0.1 * math.cos(phi)


def test_faults_in_place_have_their_line_and_dotted_key() -> None:
    text = INLINE.replace("teeth = [32, 32]", "teeth = [32, 0]").replace(
        "eccentricity", "excentricity"
    )
    lines = text.splitlines()
    first = lines.index("excentricity = 0.3") + 1
    second = lines.index("teeth = [32, 0]") + 1
    assert problems(text) == [
        f"in/outer.toml:{first}: drive.pair.law.excentricity: unknown key (its value is 0.3)",
        f"in/outer.toml:{second}: drive.pair.pair.teeth[1]: 0 is out of range",
    ]
    moved = INLINE.replace("eccentricity", "teeth")
    with pytest.raises(DesignError, match=r"belongs under \[drive\.pair\.pair\]"):
        loads(moved)
    lost = INLINE.replace("[drive.pair.pair]", "[other]")
    assert "the table [drive.pair.pair] is missing" in problems(lost)[0]


def test_faults_of_a_nested_file_have_its_name_and_line(folder: Path) -> None:
    nested = folder / "in" / "sub" / "pair.toml"
    nested.write_text(PAIR.replace("0.3", "3"))
    assert problems(BY_FILE.replace("length_mm = 70", "length_mm = 0")) == [
        "in/outer.toml:8: rod.length_mm: 0 is out of range",
        "in/sub/pair.toml:5: law.eccentricity: 3 is out of range",
    ]
    nested.write_text(PAIR.replace("[law]", "[law"))
    (told,) = problems(BY_FILE)
    assert told.startswith("in/sub/pair.toml:3: column ")
    nested.write_bytes(b"\xff")
    assert problems(BY_FILE) == ["in/sub/pair.toml:1: the byte 0xff is not UTF-8"]


@pytest.mark.parametrize(
    ("value", "told"),
    [
        ('"none.toml"', '"none.toml": there is no such file'),
        ('""', '"": there is no such file'),
        ('"sub"', '"sub": this is a folder, not a file'),
        ('"cam.toml"', '"cam.toml": its design is of kind "cam"'),
        ('"a\\u0000b"', '"a\\u0000b": this is not a possible file name'),
        ('"outer.toml"', '"outer.toml": this file would contain itself'),
        ("3", "3 is not a design"),
        ('["sub/pair.toml"]', '["sub/pair.toml"] is not a design'),
        ('{kind = "cam"}', None),
    ],
)
def test_what_is_no_such_design_is_refused_in_one_line(
    folder: Path, value: str, told: str | None
) -> None:
    (folder / "in" / "cam.toml").write_text('kind = "cam"\n')
    text = BY_FILE.replace('"sub/pair.toml"', value)
    where = "in/outer.toml:4: drive.pair: "
    if told is None:
        where, told = "in/outer.toml:4: drive.pair.kind: ", '"cam" does not belong here'
    assert problems(text) == [where + told]


def test_files_that_nest_each_other_without_end_are_refused(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A slider-crank that took another: only a kind that nests its own kind can have a cycle."""
    entry = KINDS["slider-crank"].table("drive").entries["pair"]
    monkeypatch.setitem(vars(entry.param), "nested", ("slider-crank", "gear-pair"))
    (folder / "in" / "a.toml").write_text(BY_FILE.replace("sub/pair.toml", "b.toml"))
    (folder / "in" / "b.toml").write_text(BY_FILE.replace("sub/pair.toml", "./sub/../a.toml"))
    told = '"./sub/../a.toml": this file would contain itself'
    assert problems((folder / "in" / "a.toml").read_text(), "in/a.toml") == [
        f"in/b.toml:4: drive.pair: {told}"
    ]
    for number in range(9):
        text = BY_FILE.replace("sub/pair.toml", f"{number + 1}.toml")
        (folder / "in" / f"{number}.toml").write_text(text)
    (told,) = problems((folder / "in" / "0.toml").read_text(), "in/0.toml")
    assert told.endswith("more than 4 files are nested in each other")
    deep = 'kind = "slider-crank"\n' + "".join(
        f"[drive{'.pair.drive' * depth}.pair]\nkind = 'slider-crank'\n" for depth in range(40)
    )
    assert problems(deep) == ["in/outer.toml: lists or tables are nested too deep"]


def test_a_table_beside_the_nested_file_is_found(folder: Path) -> None:
    rows = "\n".join(["phi1_deg,ratio", *(f"{angle},1.0" for angle in range(0, 361, 10))])
    (folder / "in" / "sub" / "rows.csv").write_text(rows + "\n")
    law = '[law]\ntype = "table"\nfile = "rows.csv"\n'
    text = PAIR.replace('[law]\ntype = "ellipse"\neccentricity = 0.3\n', law)
    (folder / "in" / "sub" / "pair.toml").write_text(text)
    design = gc.load("in/outer.toml")
    before = designs.hash_of(design)
    assert Path(design.drive.pair.law.file) == Path("in/sub/rows.csv")
    found = tables(BY_FILE.encode(), "in/outer.toml", [])
    assert [Path(one) for one in found] == [Path("in/sub/pair.toml"), Path("in/sub/rows.csv")]
    (folder / "in" / "sub" / "rows.csv").write_text(rows.replace("100,1.0", "100,1.01"))
    assert designs.hash_of(gc.load("in/outer.toml")) != before


def test_the_live_view_sees_a_saved_nested_file(folder: Path) -> None:
    watch = Watch("in/outer.toml")
    assert watch.look()[0]
    assert not watch.look()[0]
    (folder / "in" / "sub" / "pair.toml").write_text(PAIR.replace("0.3", "0.31"))
    assert watch.look()[0]


def test_sliders_of_a_design_in_place() -> None:
    assert numbers(INLINE)["drive.pair.law.eccentricity"] == 0.3
    made = {one["key"]: one for one in sliders(INLINE, lambda _: True, lambda *_: ())}
    entry = made["drive.pair.law.eccentricity"]
    assert (entry["low"], entry["high"]) == (0.0, pytest.approx(0.999))
    assert made["drive.pair.pair.teeth[0]"]["integer"]
    assert made["crank.length_mm"]["unit"] == "mm"


def test_schema_and_template_know_nested_designs() -> None:
    made = schema()["$defs"]["slider-crank-drive"]["properties"]["pair"]
    assert made["anyOf"] == [{"type": "string"}, {"$ref": "#/$defs/gear-pair"}]
    text = template("slider-crank", "mine")
    document = tomllib.loads(text)
    assert document["drive"]["pair"]["pair"] == {"teeth": [32, 32], "module_mm": 2}
    assert '# cam = "cam.toml"' in text
    assert loads(text).drive.pair.law.eccentricity == 0.3
    jsonschema = pytest.importorskip("jsonschema")
    checker = jsonschema.Draft202012Validator(schema())
    assert not list(checker.iter_errors(document))
    assert not list(checker.iter_errors(tomllib.loads(BY_FILE)))
    document["drive"]["pair"]["pair"]["teeth"] = [32, 0]
    assert list(checker.iter_errors(document))


TRAIN = '''"""A kind of design with several drives, each of any kind."""

from dataclasses import dataclass, field
from functools import partial

from gearcam.base.quantities import NUMBER, nested, param
from gearcam.designs.design import Design
from gearcam.designs.outputs import OutputSpec
from gearcam.designs.table import table_of
from gearcam.results.kind import Kind
from gearcam.results.result import Result


@dataclass(frozen=True, kw_only=True)
class Drive:
    of: Design = nested("gear-pair", "cam", doc="what turns")
    turns: float = param(NUMBER, default=1.0, gt=0, le=9, doc="of the driver")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class TrainDesign(Design):
    kind = "train"

    drive: tuple[Drive, ...] = ()
    output: OutputSpec = field(default_factory=OutputSpec)


PAIR = {"kind": "gear-pair", "law": {"type": "ellipse", "eccentricity": 0.1}}
PAIR["pair"] = {"teeth": [32, 32], "module_mm": 2}
KIND = Kind(
    name="train",
    doc="a train",
    design=TrainDesign,
    result=Result,
    required=("drive",),
    example={"drive": [{"of": PAIR}, {"of": PAIR, "turns": 2}]},
)
'''
DRIVE = '[[drive]]\nof = "sub/pair.toml"\n'


@pytest.fixture
def train(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder while there is a kind with several drives, too."""
    place = folder / "kinds" / "train"
    place.mkdir(parents=True)
    (place / "__init__.py").touch()
    (place / "design.py").write_text(TRAIN)
    monkeypatch.setattr(kinds, "__path__", [*kinds.__path__, str(folder / "kinds")])
    monkeypatch.delitem(sys.modules, "gearcam.kinds.train", raising=False)
    monkeypatch.delitem(sys.modules, "gearcam.kinds.train.design", raising=False)
    return folder


@pytest.mark.usefixtures("train")
def test_several_tables_each_hold_a_design_of_several_kinds() -> None:
    text = f'kind = "train"\nname = "t"\n{DRIVE}{DRIVE}turns = 2\n'
    design = loads(text, file="in/t.toml")
    assert [one.turns for one in design.drive] == [1.0, 2.0]
    pair = gc.load("in/sub/pair.toml")
    assert [one.of for one in design.drive] == [pair, pair]
    assert gc.design(design.to_dict()) == design
    other = design.with_({"drive[1].of.law.eccentricity": 0.2})
    assert [one.of.law.eccentricity for one in other.drive] == [0.3, 0.2]
    assert designs.hash_of(other) != designs.hash_of(design)
    keys = {one["key"] for one in sliders(template("train", "t"), lambda _: True, lambda *_: ())}
    assert {"drive[1].turns", "drive[1].of.law.eccentricity"} <= keys
    assert loads(template("train", "t")).drive[1].turns == 2.0


@pytest.mark.usefixtures("train")
def test_several_tables_are_refused_each_with_its_place() -> None:
    head = 'kind = "train"\nname = "t"\n'
    assert problems(head) == ["in/outer.toml:1: drive: the table [[drive]] is missing"]
    assert problems(f"{head}{DRIVE.replace('[[drive]]', '[drive]')}") == [
        "in/outer.toml:3: drive: a table is not a list of tables"
    ]
    assert problems(f"{head}{DRIVE}{DRIVE}turns = 0\n") == [
        "in/outer.toml:7: drive[1].turns: 0 is out of range"
    ]
    assert problems(f"{head}drive = [3]\n") == ["in/outer.toml:3: drive[0]: 3 is not a table"]
    nested = f"{head}[[drive]]\n[drive.of]\n[drive.of.pair]\nteeth = [5, 5]\n"
    assert problems(nested) == ["in/outer.toml:4: drive[0].of.kind: is missing"]
    nested = nested.replace("[drive.of]\n", '[drive.of]\nkind = "gear-pear"\n')
    assert problems(nested) == [
        'in/outer.toml:5: drive[0].of.kind: "gear-pear" does not belong here'
    ]
    with pytest.raises(DesignError, match=r"drive\[0\]: is a GearPairDesign"):
        type(loads(f"{head}{DRIVE}", file="in/t.toml"))(
            name="t", drive=(gc.load("in/sub/pair.toml"),)
        )
