"""Tables of a design file about many designs, not about this one: ``[sweep]``.

A build leaves them out; the commands that need them read them here.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gearcam.designs.kind import FAMILY
from gearcam.designs.reader import content_of, decoded, document_in


def family_of(file: str) -> Mapping[str, Mapping[str, Any]]:
    """Return the tables about many designs of a design `file` that can be read, by titles."""
    document = document_in(decoded(content_of(file), file), file)
    return {title: document[title] for title in FAMILY if title in document}
