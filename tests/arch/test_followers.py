"""What kind of follower or carrier there is, is asked in their own files only."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from arch import rules

FLAGS = {"flat", "oscillating", "slide", "slides"}
"""Flags that followers and carriers do not have; the settings of a design do."""

CLASSES = {"Round", "Face", "Stem", "Arm", "FlatStem", "FlatArm", "Rotating", "Sliding"}

OWN = {"followers.py", "carriers.py"}
"""Where followers and carriers are."""

SETTINGS = {"spec.py", "placing.py"}
"""Where settings of a design are, and followers are made of them."""


def questions(tree: ast.AST, flags: bool) -> Iterator[str]:
    """Yield the questions for the kind of a follower or carrier, also by `flags` if asked."""
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(attr=name) if flags and name in FLAGS:
                yield f"{node.lineno}: .{name}"
            case ast.Call(func=ast.Name(id="isinstance"), args=[_, kinds]):
                names = {part.id for part in ast.walk(kinds) if isinstance(part, ast.Name)}
                if names & CLASSES:
                    yield f"{node.lineno}: isinstance of {', '.join(sorted(names & CLASSES))}"
            case ast.MatchClass(cls=ast.Name(id=name)) if name in CLASSES:
                yield f"{node.lineno}: case {name}"


def test_nobody_asks_for_the_kind_of_a_follower() -> None:
    cams, kinds = (rules.SOURCE / folder for folder in ("cams", "kinds"))
    found = [
        f"{path.name}:{question}"
        for path in rules.python_files(cams, kinds)
        if path.name not in OWN
        for question in questions(rules.parse(path), flags=path.parent == cams)
        if path.name not in SETTINGS or "isinstance" in question
    ]
    assert found == [], "a follower answers it (cams/followers.py), or its carrier"


def test_such_questions_are_found() -> None:
    text = "x = m.flat or isinstance(f, (Stem, Arm))\nmatch c:\n    case Sliding():\n        pass\n"
    assert sorted(questions(ast.parse(text), flags=True)) == [
        "1: .flat",
        "1: isinstance of Arm, Stem",
        "3: case Sliding",
    ]
