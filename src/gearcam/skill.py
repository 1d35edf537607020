"""The page for coding assistants: how to write design files and to read what gearcam answers.

Its text is in ``skill.md`` beside this file; version, kinds, laws, exit codes and commands are put
in, so that they are those of this version.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS
from gearcam.results.kind import KINDS
from gearcam.version import __version__


def page(codes: Iterable[tuple[int, str]], commands: Iterable[tuple[str, str]]) -> str:
    """Return the page as Markdown.

    Parameters
    ----------
    codes : iterable of (int, str)
        Exit codes with their meanings.
    commands : iterable of (str, str)
        Commands with what they do.
    """
    texts = {
        "version": __version__,
        "kinds": "".join(f"   - `{name}`: {kind.doc}\n" for name, kind in KINDS.items()),
        "laws": ", ".join(f"`{name}`" for name in LAWS),
        "motion_laws": ", ".join(f"`{name}`" for name in MOTION_LAWS),
        "codes": "\n".join(f"| {code} | {meaning} |" for code, meaning in codes),
        "commands": "\n".join(f"- `gearcam {name}`: {doc}" for name, doc in commands),
    }
    text = Path(__file__).with_name("skill.md").read_text(encoding="utf-8")
    for name, content in texts.items():
        text = text.replace(f"@@{name}@@", content)
    return text
