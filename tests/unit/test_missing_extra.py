"""Without the extra for STEP files a person is told what to install, and nothing is written."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from gearcam.cli import WRONG, main

PROFILE = Path(__file__).parents[2] / "profiles" / "ellipse.toml"


def test_the_extra_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "OCP", None)
    assert main(["build", str(PROFILE), "--only", "step", "-o", str(tmp_path / "out")]) == WRONG
    told = capsys.readouterr().err
    assert 'pip install "gearcam[step]"' in told
    assert "bug in gearcam" not in told
    assert not (tmp_path / "out").exists()
