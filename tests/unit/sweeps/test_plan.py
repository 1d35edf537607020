"""Which variants a sweep has."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError
from gearcam.sweeps.axes import axes_of
from gearcam.sweeps.plan import Plan, flattened
from helpers_sweep import BASE


def plan(settings: dict[str, Any], **more: Any) -> Plan:
    return Plan(base=BASE, axes=axes_of(settings), **more)


def test_a_grid_has_all_combinations() -> None:
    teeth, shares = [[20, 20], [24, 24], [30, 30]], [0.1, 0.2]
    one = plan({"pair.teeth": teeth, "law.eccentricity": "0.1,0.2"})
    assert one.count == 6
    assert [tuple(one.values(k).values()) for k in range(6)] == list(
        itertools.product(teeth, shares)
    )


def test_samples_are_the_same_again_and_others_with_another_seed() -> None:
    axes = {"law.eccentricity": "0.1:0.5", "pair.module_mm": "1,2,3"}
    first, again, other = (plan(axes, sampling="random", samples=50, seed=k) for k in (1, 1, 2))
    values = [first.values(k) for k in range(50)]
    assert values == [again.values(k) for k in range(50)]
    assert values != [other.values(k) for k in range(50)]
    assert {one["pair.module_mm"] for one in values} == {1, 2, 3}
    assert all(0.1 <= one["law.eccentricity"] < 0.5 for one in values)


def test_a_latin_hypercube_has_one_sample_in_each_part() -> None:
    axes = {"law.eccentricity": "0.1:0.5", "pair.module_mm": "log(1, 16)"}
    one = plan(axes, sampling="latin", samples=40)
    values = [one.values(k) for k in range(40)]
    for key, share in (
        ("law.eccentricity", lambda x: (x - 0.1) / 0.4),
        ("pair.module_mm", lambda x: np.log(x) / np.log(16.0)),
    ):
        parts = np.sort([int(40 * share(value[key])) for value in values])
        assert parts.tolist() == list(range(40))


def test_a_length_is_varied_in_inches_or_in_mm() -> None:
    axes = axes_of({"pair.face_width_in": "1,2", "pair.face_width_mm": "20,30"})
    with pytest.raises(DesignError, match=r"_mm: is given beside pair\.face_width_in"):
        Plan(base=BASE.with_({"units": "inch"}), axes=axes)


def test_a_range_of_whole_numbers_is_sampled_in_whole_numbers() -> None:
    one = plan({"pair.teeth[0]": "20:30"}, sampling="random", samples=30)
    values = [one.values(k)["pair.teeth[0]"] for k in range(30)]
    assert {type(value) for value in values} == {int}
    assert min(values) >= 20
    assert max(values) <= 30
    one = plan({"pair.teeth[0]": "20.2:22.8"}, sampling="random", samples=30)
    assert {one.values(k)["pair.teeth[0]"] for k in range(30)} == {21, 22}
    with pytest.raises(DesignError, match=r"there is no whole number in 20\.2:20\.8"):
        plan({"pair.teeth[0]": "20.2:20.8"}, sampling="random", samples=3)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"law.excentricity": "0.1,0.2"}, "did you mean eccentricity"),
        ({"law.eccentricity": "0.1:0.5"}, "0.1:0.5 has no step"),
        ({"law.eccentricity": "3,4,5"}, "law.eccentricity"),
    ],
)
def test_what_no_variant_could_have_is_refused_at_once(
    settings: dict[str, Any], message: str
) -> None:
    with pytest.raises(DesignError, match=message.replace("(", r"\(")):
        plan(settings)


def test_a_key_of_which_some_values_are_wrong_is_swept() -> None:
    assert plan({"law.eccentricity": "0.2,0.4,3"}).count == 3


def test_keys_that_need_each_other_are_looked_at_together() -> None:
    sizes = {"pair.module_mm": [None], "pair.center_distance_mm": [60, 90]}
    one = plan(sizes)
    assert one.count == 2
    assert BASE.with_(one.values(1)).to_dict()["pair"]["center_distance_mm"] == 90
    with pytest.raises(DesignError, match=r"law\.excentricity: unknown key"):
        plan(sizes | {"law.excentricity": [0.1]})
    with pytest.raises(DesignError, match="module_mm"):
        plan({"pair.module_mm": [None]})


def test_the_mark_tells_sweeps_apart() -> None:
    axes = {"law.eccentricity": "0.1:0.5"}
    made = [
        plan(axes, sampling="random", samples=9),
        plan(axes, sampling="latin", samples=9),
        plan(axes, sampling="random", samples=8),
        plan(axes, sampling="random", samples=9, seed=2),
        plan({"law.eccentricity": "0.1:0.6"}, sampling="random", samples=9),
        Plan(
            base=BASE.with_({"pair.module_mm": 2.0}),
            axes=axes_of(axes),
            sampling="random",
            samples=9,
        ),
    ]
    assert len({one.mark for one in made}) == len(made)
    assert plan(axes, sampling="random", samples=9).mark == made[0].mark


def test_tables_in_tables_have_dotted_keys() -> None:
    table = {"law": {"eccentricity": "0.1:0.5"}, "pair.teeth": [1], "seed": 2}
    assert flattened(table) == {"law.eccentricity": "0.1:0.5", "pair.teeth": [1], "seed": 2}


def test_a_build_leaves_the_table_out(tmp_path: Any) -> None:
    text = 'kind = "gear-pair"\nname = "a"\n[law]\ntype = "ellipse"\neccentricity = 0.3\n'
    text += "[pair]\nmodule_mm = 1\nteeth = [24, 24]\n"
    file = tmp_path / "a.toml"
    file.write_text(text)
    plain = gc.load(file)
    file.write_text(text + '[sweep]\nlaw.eccentricity = "0.1:0.5:0.1"\n')
    assert gc.load(file) == plain
    file.write_text(text.replace("[law]", "sweep = 3\n[law]"))
    with pytest.raises(DesignError, match="3 is not a table"):
        gc.load(file)
