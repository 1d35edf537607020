"""The table ``[law]`` for the JSON schema, the template and ``gearcam laws``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from gearcam.designs.listing import Listed, listed
from gearcam.designs.schema import chosen, table_schema, with_meanings
from gearcam.designs.template import beside, entry_lines, key_line, law_comment
from gearcam.kinds.gear_pair.design import law_table
from gearcam.laws.ratio.base import LAWS


def schema() -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the schema of the table and its definitions."""
    words = with_meanings((name, entry.doc) for name, entry in LAWS.items())
    main = chosen("type", LAWS, "the law", lambda name: f"law-{name}")
    laws = {
        f"law-{name}": table_schema(
            law_table(name), f"{entry.doc} (continuity: {entry.continuity})", type=name
        )
        for name, entry in LAWS.items()
    }
    return {"type": "object", "description": f"the ratio of the pair. {words}", **main}, laws


def lines(example: Mapping[str, Any], note: str) -> Iterator[str]:
    """Yield the lines of the template: the law of the `example` and a `note`, then other laws."""
    yield beside("[law]", note)
    yield key_line("type", example["type"], LAWS[example["type"]].doc)
    yield from entry_lines(law_table(example["type"]), example)
    yield ""
    yield "# Other laws that can replace the table above, with example values:"
    for name, entry in LAWS.items():
        if name != example["type"]:
            yield from law_comment("type", name, entry, law_table(name))


def laws() -> tuple[str, list[Listed]]:
    """Return a heading and the laws of gear pairs."""
    listings = [
        listed(entry, f'law.type = "{name}"', law_table(name)) for name, entry in LAWS.items()
    ]
    head = "Laws of gear pairs: the ratio, in the table [law]; all but rack work with a ring too"
    return head, listings
