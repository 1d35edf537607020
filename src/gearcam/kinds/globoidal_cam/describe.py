"""The table ``[index]`` for the JSON schema, the template and ``gearcam laws``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from gearcam.designs.listing import Listed
from gearcam.designs.schema import chosen, table_schema, with_meanings
from gearcam.designs.template import beside, entry_lines, key_line, law_comment
from gearcam.kinds.globoidal_cam.design import TITLE, index_table, law_table
from gearcam.laws.motion.base import MOTION_LAWS


def schema() -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the schema of the table and its definitions."""
    words = with_meanings((name, entry.doc) for name, entry in MOTION_LAWS.items())
    main = chosen("law", MOTION_LAWS, "the motion law", lambda name: f"{TITLE}-{name}")
    made = {
        f"{TITLE}-{name}": table_schema(
            index_table(name), f"{entry.doc} (continuity: {entry.continuity})", law=name
        )
        for name, entry in MOTION_LAWS.items()
    }
    return {"type": "object", "description": f"the motion of the turret. {words}", **main}, made


def lines(example: Mapping[str, Any], note: str) -> Iterator[str]:
    """Yield the lines of the template: the law of the `example` and a `note`, then other laws."""
    yield beside(f"[{TITLE}]", note)
    yield key_line("law", example["law"], MOTION_LAWS[example["law"]].doc)
    yield from entry_lines(index_table(example["law"]), example)
    yield ""
    yield "# Other laws of the index, with example values:"
    for name, entry in MOTION_LAWS.items():
        if name != example["law"]:
            yield from law_comment("law", name, entry, law_table(name))


def laws() -> tuple[str, list[Listed]]:
    """Return a heading; the laws are those of all cams, which list them."""
    return f"Globoidal indexing cams have the motion laws of cams, in the table [{TITLE}]", []
