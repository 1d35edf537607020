"""The commit of the sources, for pages that say what they were made with."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[1]


def commit() -> str:
    """Return the commit that is checked out, and whether sources differ from it."""
    changed = " with uncommitted changes" if _git("status", "--porcelain", "src") else ""
    return (_git("rev-parse", "--short=12", "HEAD") or "none yet") + changed


def _git(*arguments: str) -> str:
    done = subprocess.run(
        ["git", *arguments], cwd=ROOT, check=False, capture_output=True, text=True
    )
    return done.stdout.strip() if done.returncode == 0 else ""
