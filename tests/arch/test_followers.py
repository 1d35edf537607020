"""What sort of follower or carrier there is, is asked in their own files only.

A design's follower answers for itself, too: nobody asks its settings for flags. They may be
passed on as an argument of the same name.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from arch import rules

FLAGS = {"flat", "oscillating", "slide", "slides"}
"""Flags that followers and carriers do not have; settings of a design have some for themselves."""

CLASSES = {"Round", "Face", "Stem", "Arm", "FlatStem", "FlatArm", "Rotating", "Sliding"}

OWN = {"followers", "carriers.py"}
"""Where followers and carriers are."""

ASKED = {"motion", "arm"}
"""Settings of a follower that a comparison with a name or with None would use as a flag."""

SETTINGS = {"spec.py", "placing.py"}
"""Where settings of a design are, and followers are made of them."""


def questions(tree: ast.AST, flags: bool) -> Iterator[str]:
    """Yield the questions for the sort of a follower or carrier, also by `flags` if asked."""
    passed = {
        one.value for one in ast.walk(tree) if isinstance(one, ast.keyword) and one.arg in FLAGS
    }
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(attr=name, value=owner) if (
                flags and name in FLAGS and node not in passed and not _is_self(owner)
            ):
                yield f"{node.lineno}: .{name}"
            case ast.Compare(left=ast.Attribute(attr=name), comparators=[ast.Constant()]) if (
                flags and name in ASKED
            ):
                yield f"{node.lineno}: comparison of .{name}"
            case ast.Call(func=ast.Name(id="isinstance"), args=[_, kinds]):
                names = {part.id for part in ast.walk(kinds) if isinstance(part, ast.Name)}
                if names & CLASSES:
                    yield f"{node.lineno}: isinstance of {', '.join(sorted(names & CLASSES))}"
            case ast.MatchClass(cls=ast.Name(id=name)) if name in CLASSES:
                yield f"{node.lineno}: case {name}"


def _is_self(owner: ast.expr) -> bool:
    return isinstance(owner, ast.Name) and owner.id == "self"


def test_nobody_asks_for_the_sort_of_a_follower() -> None:
    cams, kinds = (rules.SOURCE / folder for folder in ("cams", "kinds/cam"))
    found = [
        f"{path.name}:{question}"
        for path in rules.python_files(cams, kinds)
        if not OWN & {path.name, path.parent.name}
        for question in questions(rules.parse(path), flags=path.name not in SETTINGS)
    ]
    assert found == [], "a follower answers it (cams/followers), or its carrier"


def test_such_questions_are_found() -> None:
    text = "x = m.flat or isinstance(f, (Stem, Arm))\nmatch c:\n    case Sliding():\n        pass\n"
    text += "y = make(flat=m.flat) if self.flat else make(oscillating=not m.oscillating)\n"
    text += "z = f.arm is None or f.motion == 'oscillating'\n"
    assert sorted(questions(ast.parse(text), flags=True)) == [
        "1: .flat",
        "1: isinstance of Arm, Stem",
        "3: case Sliding",
        "5: .oscillating",
        "6: comparison of .arm",
        "6: comparison of .motion",
    ]
