"""Profiles that are damaged, or of other systems: read as they are meant, or refused in words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gearcam
from gearcam.cli import main
from gearcam.export.dxf_read import DxfError, read_outline
from helpers_interrupts import CAM


@pytest.fixture(scope="module")
def profile() -> bytes:
    """A cam's profile as DXF."""
    return gearcam.build(gearcam.loads(CAM)).files("dxf")["cam.dxf"]


def test_profiles_of_other_systems_are_read(profile: bytes) -> None:
    vertices, bulges = read_outline(profile)
    assert len(vertices) > 30
    latin = profile.replace(b"  0\nEOF", "999\nN\xfcrnberg\n  0\nEOF".encode("cp1252"))
    assert latin != profile
    crlf, marked = profile.replace(b"\n", b"\r\n"), b"\xef\xbb\xbf" + profile
    for other in (crlf, marked, latin):
        found = read_outline(other)
        assert np.array_equal(found[0], vertices)
        assert np.array_equal(found[1], bulges)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "cannot be read"),
        (b"\0" * 5000, "cannot be read"),
        (bytes(range(256)) * 9, "cannot be read"),
        (b"AutoCAD Binary DXF\r\n\x1a\0\0", "is binary: save it as text"),
        (b"hello\nworld\n", "cannot be read"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nLWPOLYLINE\n 10\nabc\n", "cannot be read"),
        (b"  0\nSECTION\n  2\nHEADER\n  9\n  0\nENDSEC\n  0\nEOF\n", "cannot be read"),
    ],
)
def test_what_is_no_dxf(content: bytes, words: str) -> None:
    with pytest.raises(DxfError, match=words) as refused:
        read_outline(content)
    assert len(str(refused.value)) < 150
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("old", [b"DIMSTYLE", b" 10\n0.0\n", b"SECTION", b"  0\n", b"ACAD"])
@pytest.mark.parametrize("new", [b"", b"x", b"  0\n", b" 10\nnan\n", b"\n\n\n"])
def test_damaged_dxf_files_are_read_or_refused(profile: bytes, old: bytes, new: bytes) -> None:
    assert old in profile
    for damaged in (profile.replace(old, new, 1), profile.replace(old, new)):
        try:
            vertices, bulges = read_outline(damaged)
        except DxfError:
            continue
        assert np.isfinite(vertices).all()
        assert np.isfinite(bulges).all()


def test_an_outline_of_no_numbers_is_refused(profile: bytes) -> None:
    start = profile.index(b"\n 10\n", profile.index(b"LWPOLYLINE", profile.index(b"ENTITIES")))
    end = profile.index(b"\n", start + 5)
    for number in (b"nan", b"inf", b"1e999"):
        with pytest.raises(DxfError, match="not finite"):
            read_outline(profile[: start + 5] + number + profile[end:])


def test_what_ezdxf_does_not_know_is_no_outline(profile: bytes) -> None:
    start = profile.index(b"ENTITIES")
    other = profile[:start] + profile[start:].replace(b"LWPOLYLINE", b"POLYGLINE")
    with pytest.raises(DxfError, match="holds no closed outline"):
        read_outline(other)


def test_what_is_no_profile(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    profile: bytes,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("good.toml").write_text(CAM)
    Path("half.dxf").write_bytes(profile[: len(profile) // 2])
    Path("head.csv").write_text("x_mm,y_mm\n")
    for name in ("huge.csv", "huge.DXF"):
        with Path(name).open("wb") as stream:
            stream.truncate(100_000_000)
    for name, code, words in (
        ("half.dxf", 2, "the DXF file cannot be read"),
        ("head.csv", 3, "the profile has too few points"),
        ("huge.csv", 2, "has 100 MB, but files of at most 16 MB are read"),
        ("huge.DXF", 2, "has 100 MB, but files of at most 16 MB are read"),
        ("/dev/null", 2, "this is a pipe or a device, not a file"),
        ("none.dxf", 2, "there is no such file"),
        (".", 2, "this is a folder, not a file"),
    ):
        assert main(["follow", "good.toml", name]) == code
        err = capsys.readouterr().err
        assert words in err
        assert "Traceback" not in err
    assert not Path("output").exists()
