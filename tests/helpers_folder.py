"""Writes files into a folder with a summary of them, as a build does."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from gearcam.export.listing import Replacement, planned
from gearcam.export.write import SUMMARY, writing


def put(
    folder: Path, files: Mapping[str, bytes], version: str = "of a design", *, keep: bool = False
) -> Replacement:
    """Write files and their summary; return what became of the old ones."""
    with writing(folder) as replace:
        plan = planned(folder, files, version, keep=keep)
        summary = json.dumps({"format": 1, **plan.about}).encode()
        replace({**files, SUMMARY: summary}, plan.removed, plan.renamed)
    return plan
