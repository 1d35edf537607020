"""Findings say how a value keeps its limit, by what their check declares."""

from __future__ import annotations

import ast
import inspect
import math
import textwrap

import pytest

import gearcam as gc
from gearcam.base.findings import CHECKS, Finding, Remark, check
from gearcam.base.quantities import NUMBER, Param
from gearcam.designs.kind import KINDS
from gearcam.sweeps.rows import measured

for _kind in KINDS.values():
    _kind.load_checks()

OTHER_WORDS = {
    "concave": "at least",  # concave radii below this are reported
    "tool-too-large": "at least",  # diameter of the tool at hand: the largest tool is compared
    "jamming": "at most",  # pressure angle that jams
    "resonance": "about",  # how near two frequencies may be
}
"""Relations where the text of the key does not begin with least or largest."""

WITHOUT_KEYS = {
    "assemblies-jam": "at least",
    "coarse-rows": "at most",
    "energy": "at most",
    "guide-distance": "at least",
    "interference": "at most",
    "irregularity": "at most",
    "jams": "at least",
    "lift-error": "at most",
    "loose-turret": "at least",
    "no-dwell": "at least",
    "other-profile": "at most",
    "remote-cutter": "at most",
    "self-locking": "at least",
    "stress-error": "at most",
    "unknown-law": "at most",
    "wide-kerf": "at most",
    "contact-ratio": "at least",
    "undercut": "at least",  # of globoidal cams: the spread
}
"""Relations of checks whose limits have no key."""


@pytest.mark.parametrize("entry", CHECKS.values(), ids=lambda one: f"{one.kind}: {one.code}")
def test_relation_of_a_check_is_that_of_its_limit(entry):
    if entry.limit is None:
        source = textwrap.dedent(inspect.getsource(inspect.unwrap(entry.run)))
        limited = any(
            isinstance(node, ast.keyword)
            and node.arg == "limit"
            and isinstance(node.value, ast.expr)
            and not (isinstance(node.value, ast.Attribute) and node.value.attr == "inf")
            for call in ast.walk(ast.parse(source))
            if isinstance(call, ast.Call) and getattr(call.func, "id", "") == "Remark"
            for node in call.keywords
        )
        assert entry.relation == (WITHOUT_KEYS[entry.code] if limited else None)
        return
    words = entry.limit[1].doc.split()[0]
    named = {"largest": "at most", "least": "at least", "fewest": "at least"}.get(
        words
    ) or OTHER_WORDS[entry.code]
    assert entry.relation == named


def test_limit_without_a_relation_is_a_mistake_of_the_program():
    key = ("size", Param(NUMBER, gt=0, doc="largest size"), 1.0)
    with pytest.raises(ValueError, match="does not say"):
        check("no-relation", kind="nothing", limit=key)(lambda _subject, _limit: ())

    run = check("late-limit", kind="nothing")(lambda _subject, _limit: [Remark("m", limit=2.0)])
    assert [one.limit for one in run(None, math.nan)] == [None]
    late = check("later-limit", kind="nothing")
    run = late(lambda _subject, _limit: [Remark("m", value=1.0, limit=2.0)])
    with pytest.raises(ValueError, match="does not say"):
        list(run(None, math.nan))
    for code in ("late-limit", "later-limit"):
        del CHECKS["nothing", code]


@pytest.mark.parametrize("value", [0.003, 0.01, 0.02])
def test_words_do_not_depend_on_the_numbers(value):
    found = Finding(
        code="c", severity="note", message="m", value=value, limit=0.01, relation="at most"
    )
    assert found.limit_text == "at most 0.01"


def test_loss_below_its_limit_keeps_it_in_words_and_in_a_search(tmp_path):
    """The velocity falls at once at the top: trimming loses 0.003 mm, and 0.01 mm are allowed."""
    file = tmp_path / "corner.toml"
    file.write_text(
        'kind = "cam"\n[[motion]]\ntype = "rise"\nlaw = "constant-velocity"\nangle_deg = 160\n'
        'lift_mm = 14\n[[motion]]\ntype = "return"\nlaw = "3-4-5"\nangle_deg = "rest"\n'
        '[follower]\ntype = "roller"\nroller_radius_mm = 3\n[cam]\nbase_radius_mm = 40\n'
        'thickness_mm = 5\n[goal]\nminimize = "cam.profile.radius_mm.max"\nfindings = "warning"\n'
    )
    design = gc.load(file)
    findings = gc.build(design).findings
    (loss,) = (one for one in findings if one.code == "undercut")
    assert loss.value < loss.limit
    assert loss.limit_text == "at most 10 um"
    assert loss.as_dict()["relation"] == "at most"
    # two jumps without a limit count 1 each, the loss nothing
    assert measured(design, 0, {}).excess == pytest.approx(2.0, abs=1e-9)
