"""The token in the address lasts for a file and a port, by a key that nobody else can read."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from gearcam.view.server import Server
from gearcam.view.token import state_folder, token_of
from helpers_view import DESIGN, free_port, shown

PORT = 8123


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of this user's state."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setattr(sys, "platform", "linux")
    return tmp_path / "state" / "gearcam"


def key(home: Path) -> Path:
    (found,) = home.iterdir()
    return found


def test_a_file_and_a_port_have_the_same_token_again_and_others_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    token = token_of("a.toml", PORT)
    assert (
        token == token_of("a.toml", PORT) == token_of(str(tmp_path / "x" / ".." / "a.toml"), PORT)
    )
    assert len({token, token_of("a.toml", PORT + 1), token_of("b.toml", PORT)}) == 3
    assert len(token) >= 20
    assert token.replace("-", "").replace("_", "").isalnum()


def test_a_server_that_is_started_again_has_its_address_again_and_is_another_run(
    tmp_path: Path,
) -> None:
    file, port = tmp_path / "wheels.toml", free_port()
    file.write_text(DESIGN)
    addresses, runs = set(), set()
    for _ in range(2):
        with shown(file) as view, Server(view.session, port) as server:
            addresses.add(server.address)
            runs.add(server.run)
    assert len(addresses) == 1
    assert len(runs) == 2


@pytest.mark.skipif(os.name != "posix", reason="rights of files")
def test_nobody_else_can_read_the_key(home: Path) -> None:
    old = os.umask(0)
    try:
        token_of("a.toml", PORT)
    finally:
        os.umask(old)
    assert key(home).stat().st_mode & 0o777 == 0o600
    assert home.stat().st_mode & 0o777 == 0o700
    assert len(key(home).read_bytes()) == 32


@pytest.mark.skipif(os.name != "posix", reason="rights of files")
def test_a_key_that_others_could_read_or_that_is_cut_off_is_replaced(home: Path) -> None:
    token = token_of("a.toml", PORT)
    key(home).chmod(0o644)
    second = token_of("a.toml", PORT)
    assert key(home).stat().st_mode & 0o777 == 0o600
    key(home).write_bytes(key(home).read_bytes()[:5])
    third = token_of("a.toml", PORT)
    assert len({token, second, third}) == 3
    assert third == token_of("a.toml", PORT)


def test_tokens_are_random_where_no_key_can_be_kept(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "state").write_text("in the way")
    tokens = {token_of("a.toml", PORT) for _ in range(2)}
    assert len(tokens) == 2
    assert min(map(len, tokens)) >= 20
    assert capsys.readouterr() == ("", "")


def test_a_port_that_the_system_chooses_needs_no_key(home: Path) -> None:
    assert token_of("a.toml", 0) != token_of("a.toml", 0)
    assert not home.exists()


@pytest.mark.parametrize(
    ("platform", "values", "expected"),
    [
        ("linux", {"XDG_STATE_HOME": "/s"}, "/s/gearcam"),
        ("linux", {"XDG_STATE_HOME": "s"}, "/home/one/.local/state/gearcam"),  # not absolute
        ("linux", {}, "/home/one/.local/state/gearcam"),
        ("darwin", {"XDG_STATE_HOME": "/s"}, "/home/one/Library/Application Support/gearcam"),
        ("win32", {"LOCALAPPDATA": "/l"}, "/l/gearcam"),
        ("win32", {}, "/home/one/AppData/Local/gearcam"),
    ],
)
@pytest.mark.skipif(os.name != "posix", reason="paths as there")
def test_the_key_is_kept_where_the_system_has_it(
    platform: str, values: dict[str, str], expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setenv("HOME", "/home/one")
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    for name, value in values.items():
        monkeypatch.setenv(name, value)
    assert state_folder() == Path(expected)
