"""One meaning for a word: class names, banned words, the glossary."""

from __future__ import annotations

import ast
import re
from collections import Counter

from arch import rules

BANNED = {
    "play": "backlash",
    "hang|hangs|hung": "register",
    "feeds?": "rack travel",
    "strokes?": "profile segment",
    "tip curve": "addendum curve",
    "contact-off-flank": "fillet interference",
    "lens(?:es)?": "contact patch",
    "foremost": "leading tooth pair",
    "idle": "non-contact",
    "halves": "half-teeth",
}
"""Words that have gone, and what is said instead."""

ELSEWHERE = {
    "strokes?": (
        "laser_sheet.py",
        "nest.py",
        "svg.py",
        "cut_svg.py",
        "sheet_svg.py",
        "slider.py",
        "linkages",
        "mechanism",
        "markup.py",
        "stress_field.py",
    ),
    "feeds?": ("simple.py", "tool.py", "milling.py", "milled.py", "gcode.py"),
    "idle": ("numerals.py", "paper.py", "motor.py", "motors.py"),
    "halves": ("sampling.py", "openings.py"),
}
"""Files and folders in which a word is the field's own, or plain English: strokes of a pen or
slide, machine feeds, idle zeros of a number and speeds of motors, halves of an interval."""

TERMS = (
    "centrode", "addendum curve", "form point", "fillet interference", "backlash", "contact ratio",
    "overclosure", "rack travel", "stepped gear", "knife-edge follower", "profile segment",
    "pitch curve", "prime circle", "base circle", "cam profile", "pressure angle", "undercut",
    "transmission error", "track", "wall", "groove cam", "lost motion",
    "body", "lift", "profile shift", "contact patch",
    "half-tooth", "edge contact", "non-contact stretch", "leading tooth pair",
)  # fmt: skip
GLOSSARY = (rules.ROOT / "docs" / "conventions.md").read_text("utf-8")
GLOSSARY = GLOSSARY.partition("\n## Glossary\n")[2].partition("\n## ")[0]


def test_class_names_have_one_meaning() -> None:
    names = Counter(
        node.name
        for path in rules.python_files(rules.SOURCE)
        for node in rules.parse(path).body
        if isinstance(node, ast.ClassDef)
    )
    assert [name for name, count in names.items() if count > 1] == []
    assert len(names) > 100


def banned(line: str, *places: str) -> list[str]:
    """The banned words of a line of a file in a folder, with what to say instead."""
    return [
        f"{told[0]}: say {instead}"
        for word, instead in BANNED.items()
        if (told := re.search(rf"(?<![\w.-]|_)(?:{word})(?![\w])", line, re.IGNORECASE))
        if not {*places} & {*ELSEWHERE.get(word, ())}
    ]


def test_a_banned_word_is_not_said() -> None:
    any_word = re.compile("|".join(BANNED), re.IGNORECASE)
    said = [
        f"{path.name}:{number}: {fault}"
        for path in rules.python_files(rules.SOURCE)
        for number, line in enumerate(path.read_text("utf-8").splitlines(), start=1)
        if any_word.search(line)
        for fault in banned(line, path.name, path.parent.name)
    ]
    assert said == []


def test_a_banned_word_would_be_seen() -> None:
    assert banned("def take(play: float)") == ["play: say backlash"]
    assert banned("feed of a tool", "tool.py") == banned("display, lead-play") == []


def test_the_glossary_is_complete_and_names_its_sources() -> None:
    rows = [line.strip("|").split("|") for line in GLOSSARY.splitlines() if line.startswith("| ")]
    told = {cells[0].strip(): cells[1].strip() for cells in rows[1:]}
    assert [term for term in TERMS if term not in told] == []
    for term, source in told.items():
        assert re.search(r"\b(?:Litvin|ISO|Norton)\b|^ours$", source), term
