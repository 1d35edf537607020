"""``gearcam laws``: every law with its keys, then the sources that they cite."""

from __future__ import annotations

import re

import pytest

from gearcam.cli import main
from gearcam.laws.entry import SOURCES
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.ratio import LAWS


def test_laws_shows_every_law_with_keys_continuity_and_source(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["laws"]) == 0
    out = capsys.readouterr().out
    flat = " ".join(out.split())
    for name, law in LAWS.items():
        assert f'law.type = "{name}"' in out
        assert " ".join(law.continuity.split()) in flat
        assert " ".join(law.source.split()) in flat
    assert "knots_deg" in out
    assert "from 0 to below 1" in flat
    for name, rise in MOTION_LAWS.items():
        assert f'    law = "{name}"\n' in out.partition("Motion laws of cams")[2]
        assert " ".join(rise.source.split()) in flat


def test_laws_ends_with_author_title_place_and_year_of_every_source_cited(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["laws"]) == 0
    listed = capsys.readouterr().out.partition("\nSources\n")[2]
    cited = [entry.source for entry in (*LAWS.values(), *MOTION_LAWS.values())]
    own = ("by definition", "classical; ", "quintics ")
    for citation in cited:
        (author,) = [name for name in (*SOURCES, *own) if citation.startswith(name)]
        assert author in own or f"\n{author}\n    " in listed
    for name, text in SOURCES.items():
        assert any(name in citation for citation in cited)
        assert text in " ".join(listed.split())
        assert re.search(r", (19|20)\d\d$", text)
