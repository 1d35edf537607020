from __future__ import annotations

from typing import Any

from gearcam.export.table import outline_bytes


def _text(result: Any, _: dict[str, Any]) -> dict[str, bytes]:
    return {"spacer.txt": repr(result.outline.tolist()).encode()}


FILES = {
    "csv": lambda result, _: {"spacer.csv": outline_bytes(result.outline)},
    "outline-txt": _text,
}
