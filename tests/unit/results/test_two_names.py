"""Facts that repeat a key under another name, keys left out by None, and lists in tables."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

import gearcam as gc
from arch import rules
from gearcam.base.two_names import fact_of, key_of
from gearcam.cli import main
from gearcam.designs.design import document_of, value_at
from gearcam.results.kind import KINDS
from helpers_built import built

PROFILES = rules.ROOT / "profiles"
ELLIPSE = PROFILES / "ellipse.toml"

REPEATED = [(kind, *names) for kind in KINDS for names in KINDS[kind].repeated.items()]


def test_either_name_is_found() -> None:
    keys = {"pair.rack": "rack", "cam.arm_mm": "follower.arm_mm"}
    for fact, key in (("pair.rack.addendum", "rack.addendum"), ("cam.arm_mm", "follower.arm_mm")):
        assert key_of(keys, fact) == key
        assert key_of(keys, key) == key
        assert fact_of(keys, key) == fact
        assert fact_of(keys, fact) == fact
    assert key_of(keys, "pair.racks") == "pair.racks"


def samples() -> dict[str, list[Any]]:
    """Some designs of each kind, whose facts do not take long."""
    names = {
        "gear-pair": ["nail_machine_three_phase"],
        "cam": [
            "conjugate_cams",
            "tappet",
            "valve_lever",
            "plate_cam_offset_roller",
            "lathe_slide",
        ],
        "spatial-cam": ["carton_pusher"],
        "globoidal-cam": [],
    }
    results = {
        kind: [built(PROFILES / f"{one}.toml") for one in many] for kind, many in names.items()
    }
    cone = gc.load(PROFILES / "carton_pusher.toml").with_({"follower.cone_deg": 6.0})
    results["spatial-cam"].append(built(cone))
    indexer = gc.load(PROFILES / "globoidal_indexer.toml").with_({"output.wall_step_deg": 3})
    results["globoidal-cam"].append(built(indexer))
    return results


@pytest.mark.parametrize(("kind", "fact", "key"), REPEATED)
def test_a_fact_that_is_said_to_repeat_a_key_does(kind: str, fact: str, key: str) -> None:
    met = 0
    for result in samples()[kind]:
        facts, document = result.facts_without_accuracy, document_of(result.design)
        for name in facts:
            if name != fact and not name.startswith(f"{fact}."):
                continue
            own = key + name[len(fact) :]
            if isinstance(value := value_at(document, own), int | float):  # none is sought
                met += 1
                assert facts[name] == pytest.approx(value, rel=1e-12)
                assert facts[own] == facts[name]
                assert facts.quantity(own).name == name
                assert own in facts
        # the name of the fact is not that of another key
        assert value_at(document, fact) is None
        with pytest.raises(gc.DesignError, match=r"unknown (key|table)"):
            gc.design({**document, **_nested(fact, 1.0, document)})
    assert met


def _nested(key: str, value: Any, document: dict[str, Any]) -> dict[str, Any]:
    title, _, rest = key.partition(".")
    table = document.get(title, {})
    return {title: {**table, **({rest: value} if "." not in rest else _nested(rest, value, table))}}


def test_the_name_of_a_fact_changes_the_key() -> None:
    pair = gc.load(ELLIPSE).with_({"pair.rack.addendum": 0.9})
    assert pair == gc.load(ELLIPSE).with_({"rack.addendum": 0.9})
    assert pair.to_dict()["rack"]["addendum"] == 0.9
    cam = gc.load(PROFILES / "plate_cam_offset_roller.toml").with_({"cam.roller_radius_mm": 7.0})
    assert cam.to_dict()["follower"]["roller_radius_mm"] == 7.0
    with pytest.raises(gc.DesignError, match=r"rack\.adendum: unknown key"):
        pair.with_({"pair.rack.adendum": 1.0})


def test_a_goal_may_be_named_by_its_key() -> None:
    design = gc.load(ELLIPSE).with_({"goal.minimize": ["rack.addendum"]})
    assert design.goal.minimize == ("pair.rack.addendum",)  # pyright: ignore
    assert design.goal.signs == {"pair.rack.addendum": 1.0}  # pyright: ignore
    gc.build(design).demand_goals()


def test_a_sweep_by_the_name_of_a_fact_is_one_by_its_key(tmp_path: Path) -> None:
    tables = []
    for name in ("pair.rack.addendum", "rack.addendum"):
        setting = ["--set", f"{name}=0.9,1.0", "--set", "pair.teeth=[20,20],[24,24]"]
        folder = tmp_path / name
        assert main(["sweep", str(ELLIPSE), *setting, "--jobs", "1", "-o", str(folder)]) == 0
        with (folder / "sweep.csv").open() as file:
            tables.append([{**row, "time_s": ""} for row in csv.DictReader(file)])
    assert tables[0] == tables[1]
    assert [row["rack.addendum"] for row in tables[0]] == ["0.9", "0.9", "1.0", "1.0"]
    # a list has one form, swept or not
    first = {row["pair.teeth"] for row in tables[0]}
    assert first == {"[20, 20]", "[24, 24]"}
    assert json.loads(min(first)) == [20, 20]
    changed = gc.load(ELLIPSE).with_({"pair.teeth": [20, 20]})
    assert gc.build(changed).record()["pair.teeth"] == "[20, 20]"


def test_none_leaves_a_key_out() -> None:
    design = gc.load(ELLIPSE).with_({"rack.addendum": 0.9, "drive.speed_rpm": 60})
    assert design.with_({"rack.addendum": None, "drive.speed_rpm": None}) == gc.load(ELLIPSE)
    assert design.with_({"pair.rack": None, "drive": None}) == gc.load(ELLIPSE)
    assert gc.load(ELLIPSE).with_({"rack.addendum": None}) == gc.load(ELLIPSE)
    sized = design.with_({"pair.module_mm": None, "pair.center_distance_mm": 100.0})
    assert sized.to_dict()["pair"]["center_distance_mm"] == 100.0


@pytest.mark.parametrize(
    ("key", "told"),
    [
        ("rack.adendum", "rack.adendum: unknown key"),
        ("rac", "rac: unknown key"),
        ("rac.addendum", "rac: unknown table"),
        ("pair.teeth", "pair.teeth: is missing"),
        ("pair.module_mm", "one of"),
        ("law.phi1_deg[0]", "law.phi1_deg: unknown key"),
        ("pair.teeth[0]", "None is not a whole number"),
    ],
)
def test_none_does_not_hide_a_mistake(key: str, told: str) -> None:
    with pytest.raises(gc.DesignError) as refusal:
        gc.load(ELLIPSE).with_({key: None})
    assert told in str(refusal.value)


def test_a_law_says_its_name() -> None:
    assert "name='ellipse'" in repr(built(ELLIPSE).law)
    assert built(ELLIPSE).law.name == "ellipse"
    pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    law = gc.laws.Formula(ratio=lambda phi1: 1.0 + 0.0 * phi1)
    assert "name='formula'" in repr(gc.build(gc.GearPairDesign(name="a", law=law, pair=pair)).law)
