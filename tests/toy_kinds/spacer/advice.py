from __future__ import annotations

from typing import Any

FILE_DEMANDS: dict[str, Any] = {}


def seek(search: Any, refusal: Any) -> None:
    search.follow(refusal.ways if refusal else ())


def hopeless(_: Any) -> bool:
    return False


def moves(_design: Any, _other: Any) -> bool:
    return False
