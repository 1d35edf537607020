"""The page of variants: charts with the curves of all, and their outlines superimposed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from gearcam.compare.table import rows, units_of
from gearcam.compare.variants import Variant
from gearcam.numeric.pose import Pose
from gearcam.pictures import drawings
from gearcam.pictures.charts import Chart, Limit
from gearcam.pictures.scenes import PLACES, MovingBody, Scene
from gearcam.report.data import chart_data, scene_data
from gearcam.report.page import BLOCKS, rendered, verdict

PAGE: Final = "compare.html"
"""Name of the file."""


def document(variants: Sequence[Variant], title: str) -> dict[str, Any]:
    """Return the content of the page of variants (see `gearcam.report.page`).

    Parameters
    ----------
    variants : sequence of Variant
        At least one that can be made.
    title : str
        Title of the page.
    """
    made = [one for one in variants if one.scene is not None]
    known = [(k, one.scene) for k, one in enumerate(made) if one.scene is not None]
    drawn = [(k, scene) for k, scene in known if scene.driver == known[0][1].driver]
    scenes = _together([scene for _, scene in drawn])
    context = {
        "title": title,
        "variants": variants,
        "made": made,
        "drawn": [made[k].label for k, _ in drawn],
        "verdicts": {one.label: verdict(one.result, one.result.findings) for one in made},
        "first": rows(variants),
        "every": rows(variants, every=True),
    }
    blocks = dict.fromkeys(BLOCKS, "")
    blocks |= {name: rendered(f"variants_{name}.html", context) for name in ("verdict", "facts")}
    return {
        "title": title,
        "kind": made[0].result.design.kind,
        "compared": True,
        "blocks": blocks,
        "scene": _laid_over(scenes, [k for k, _ in drawn]),
        "charts": [_chart(name, made, scenes[0].driver) for name in made[0].result.charts],
    }


def _chart(name: str, made: Sequence[Variant], driver: str) -> dict[str, Any]:
    """Return the data of a chart whose lines know their variants.

    ``variant`` is the number of the variant, which chooses the colour, and ``called`` its label;
    ``kind`` is the number of the line in its own chart, which chooses the dashes, and ``what`` its
    label there.
    """
    alike = _alike(name, made)
    own = [
        {"variant": k, "called": made[k].label, "kind": kind, "what": line.label}
        for k, chart in alike
        for kind, line in enumerate(chart.lines)
    ]
    whole = _one_of([(made[k].label, chart) for k, chart in alike])
    data = chart_data(name, whole, driver, units_of(made))
    lines = [{**line, **whose} for line, whose in zip(data["lines"], own, strict=True)]
    return {**data, "lines": lines}


def _alike(name: str, variants: Sequence[Variant]) -> list[tuple[int, Chart]]:
    """Return the charts of a `name` with the axes of the first one, with numbers of variants."""
    charts = [
        (k, one.result.chart(name)) for k, one in enumerate(variants) if name in one.result.charts
    ]
    first = charts[0][1]
    return [(k, one) for k, one in charts if (one.x, one.y) == (first.x, first.y)]


def joined(name: str, variants: Sequence[Variant]) -> Chart:
    """Return one chart with the lines of all variants.

    Parameters
    ----------
    name : str
        Name of a chart of the first variant.
    variants : sequence of Variant
        Variants that can be made; those without it or with different axes are left out.

    Returns
    -------
    Chart
    """
    return _one_of([(variants[k].label, chart) for k, chart in _alike(name, variants)])


def _one_of(charts: Sequence[tuple[str, Chart]]) -> Chart:
    """Return one chart with the lines of all, by the labels of their variants."""
    first = charts[0][1]
    lines, limits = [], []
    for label, chart in charts:
        single = len(chart.lines) == 1
        lines += [
            replace(line, label=label if single else f"{label}: {line.label}")
            for line in chart.lines
        ]
        limits += [(label, limit) for limit in chart.limits]
    shared = (mark for mark in first.marks if all(mark in chart.marks for _, chart in charts))
    return replace(first, lines=(*lines,), limits=_limits(limits), marks=(*shared,))


def _limits(limits: Sequence[tuple[str, Limit]]) -> tuple[Limit, ...]:
    """Return each limit once; limits that differ are labelled with their variant."""
    values: dict[str, set[float]] = {}
    for _, limit in limits:
        values.setdefault(limit.label, set()).add(limit.value)
    own = (
        limit if len(values[limit.label]) == 1 else replace(limit, label=f"{label}: {limit.label}")
        for label, limit in limits
    )
    return tuple(dict.fromkeys(own))


def _together(scenes: Sequence[Scene]) -> list[Scene]:
    """Return scenes over common places of the driver, those of the longest cycle."""
    if all(np.array_equal(one.places, scenes[0].places) for one in scenes):
        return list(scenes)
    start, end = min(one.places[0] for one in scenes), max(one.places[-1] for one in scenes)
    places = np.linspace(start, end, PLACES + 1)
    return [_over(one, places) for one in scenes]


def _over(scene: Scene, places: np.ndarray) -> Scene:
    """Return a scene over other places: a closed one repeats, an open one stops at its end."""
    first, last = scene.places[0], scene.places[-1]
    cycles = np.floor((places - first) / (last - first)) if scene.closed else 0.0 * places
    within = places - cycles * (last - first)  # interp keeps the value at the end

    def moved(body: MovingBody) -> MovingBody:
        turn, shift = body.pose.turn, body.pose.shift
        turn = np.interp(within, scene.places, turn) + cycles * (turn[-1] - turn[0])
        return replace(body, pose=Pose(turn, np.interp(within, scene.places, shift)))

    bodies = tuple(moved(body) for body in scene.bodies)
    return replace(
        scene,
        places=places,
        closed=False,
        bodies=bodies,
        contacts={},
        pitch=None,
        in_space={},
    )


def _laid_over(scenes: Sequence[Scene], numbers: Sequence[int]) -> dict[str, Any]:
    """Return a scene with the bodies of the first variant and the outlines of the others.

    Each body has the number of its ``variant``, which chooses the colour. Nothing is coloured by
    values, which would be those of the first variant only.
    """
    first = scenes[0]
    others = [
        (k, replace(body, features=kept))
        for k, scene in zip(numbers[1:], scenes[1:], strict=True)
        for body in scene.bodies
        if (kept := tuple(one for one in body.features if one.kind not in drawings.DASHED))
    ]
    bodies = (*first.bodies, *(body for _, body in others))
    closed = all(one.closed for one in scenes)
    flat = replace(first, bodies=bodies, closed=closed, coloured=(), in_space={})  # without solids
    data = scene_data(flat)
    for body in data["bodies"][: len(first.bodies)]:
        body["variant"] = numbers[0]
    for (k, _), body in zip(others, data["bodies"][len(first.bodies) :], strict=True):
        chains = [*body["metal"], *body["floor"]]
        body["lines"] += [
            {"layer": "OUTLINE", "points": points, "closed": True, "dashed": False}
            for points in chains
        ]
        body |= {"metal": [], "floor": [], "teeth": None, "variant": k}
    return data
