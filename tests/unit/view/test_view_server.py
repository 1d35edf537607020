"""The live view answers its own page and nobody else."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from http.client import HTTPConnection
from pathlib import Path

import pytest

from gearcam.base.errors import DesignError
from gearcam.view.server import LARGEST, Server
from helpers_view import DESIGN, SECONDS, Shown, ask, served, shown

WISH = b'{"changes": {"pair.module_mm": 2.5}, "last": "pair.module_mm"}'


@pytest.fixture(scope="module")
def view(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Server, Shown]]:
    file = tmp_path_factory.mktemp("view") / "wheels.toml"
    file.write_text(DESIGN)
    with served(file) as made:
        yield made


@pytest.fixture
def server(view: tuple[Server, Shown]) -> Server:
    return view[0]


def test_the_page_is_served_and_told_to_no_one_else(server: Server) -> None:
    answer, content = ask(server, "")
    assert answer.status == 200
    assert b'id="live"' in content
    assert server.token.encode() in content
    assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
    assert answer.headers["Cache-Control"] == "no-store"
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    assert answer.headers["Referrer-Policy"] == "no-referrer"
    policy = answer.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "http" not in policy
    assert "Python" not in answer.headers["Server"]
    assert server.server_address[0] == "127.0.0.1"
    assert "Access-Control-Allow-Origin" not in answer.headers


def test_tokens_are_long_and_never_the_same(view: tuple[Server, Shown]) -> None:
    with Server(view[1].session) as other:
        assert other.token != view[0].token
        assert len(other.token) >= 20


@pytest.mark.parametrize(
    "path",
    [
        "/", "/x/", "/{token}", "//{token}/", "/{token}x/", "/{token}/../", "/{token}/..",
        "/{token}/../{token}/", "/{token}/%2e%2e/", "/{token}/%2e", "/{token}//", "/{token}/./",
        "/{token}/page.html", "/{token}/wheels.toml", "/{token}//etc/passwd", "/{token}/?a=1",
        "/{token}/document?", "/{token}/#a", "/{token}/%64ocument", "/{token}/Document",
        "/{token}/document/", "/{token}/..%2f..%2fetc%2fpasswd", "/{token}/..\\..\\wheels.toml",
        "http://127.0.0.1/{token}/", "/{token}/document%00", "/{token}/follow", "/{token}/save",
        "/{token}/remedies", "/{token}/solids",
        "*", "/{half}", "/%ff{token}/",
    ],
)  # fmt: skip
def test_there_is_nothing_at_any_other_path(server: Server, path: str) -> None:
    token = server.token
    answer, content = ask(server, "", path=path.format(token=token, half=token[:11]))
    assert answer.status == 404
    assert json.loads(content) == {"error": "there is no such page"}
    assert "Content-Security-Policy" in answer.headers


def test_a_token_that_is_not_the_right_one_opens_nothing(server: Server) -> None:
    wrong = "A" * len(server.token)
    for route in ("", "document", "events"):
        assert ask(server, "", path=f"/{wrong}/{route}")[0].status == 404
    for route in ("follow", "remedies", "solids", "save"):
        assert ask(server, "", WISH, path=f"/{wrong}/{route}")[0].status == 404


@pytest.mark.parametrize(
    "hosts",
    [
        (), ("evil.example",), ("evil.example:{port}",), ("127.0.0.1",), ("localhost",),
        ("127.0.0.1:1",), ("127.0.0.1:{port}", "evil.example"), ("127.0.0.1:{port}.evil.example",),
        ("0.0.0.0:{port}",), ("[::1]:{port}",), ("127.0.0.2:{port}",),
    ],
)  # fmt: skip
def test_another_host_is_not_served(server: Server, hosts: tuple[str, ...]) -> None:
    named = tuple(host.format(port=server.server_port) for host in hosts)
    for route, body in (("", None), ("document", None), ("events", None), ("follow", WISH)):
        assert ask(server, route, body, hosts=named)[0].status == 403


def test_both_names_of_this_computer_are_served(server: Server) -> None:
    for name in ("127.0.0.1", "localhost"):
        assert ask(server, "", hosts=(f"{name}:{server.server_port}",))[0].status == 200


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "https://127.0.0.1:{port}", "http://127.0.0.1", "file://"],
)
def test_another_origin_is_not_served(server: Server, origin: str) -> None:
    headers = {"Origin": origin.format(port=server.server_port)}
    for route, body in (("", None), ("document", None), ("remedies", WISH), ("save", WISH)):
        assert ask(server, route, body, headers=headers)[0].status == 403


def test_its_own_origin_is_served(server: Server) -> None:
    for name in ("127.0.0.1", "localhost"):
        headers = {"Origin": f"http://{name}:{server.server_port}"}
        assert ask(server, "follow", WISH, headers=headers)[0].status == 200


@pytest.mark.parametrize("route", ["follow", "remedies", "solids", "save"])
@pytest.mark.parametrize(
    ("headers", "body", "status"),
    [
        ({"Content-Type": "text/plain"}, WISH, 415),
        ({"Content-Type": "application/x-www-form-urlencoded"}, WISH, 415),
        ({"Content-Type": ""}, WISH, 415),
        ({"Content-Length": ""}, WISH, 411),
        ({"Content-Length": "-1"}, WISH, 411),
        ({"Content-Length": "1e3"}, WISH, 411),
        ({"Content-Length": "", "Transfer-Encoding": "chunked"}, b"", 411),
        ({"Content-Length": str(LARGEST + 1)}, WISH, 413),
        ({"Content-Length": "9" * 5000}, WISH, 413),
        ({}, b"{", 400),
        ({}, b"[]", 400),
        ({}, b"\xff", 400),
        ({}, b"[" * 50_000, 400),
    ],
)
def test_what_is_no_small_json_object_is_refused(
    server: Server, route: str, headers: dict[str, str], body: bytes, status: int
) -> None:
    answer, content = ask(server, route, body, headers=headers)
    assert answer.status == status
    assert json.loads(content)["error"]
    assert answer.headers["Connection"] == "close"


@pytest.mark.parametrize(
    "asked",
    [
        {},
        {"changes": []},
        {"changes": {}},
        {"changes": {"pair.module_mm": 2}},
        {"changes": {"pair.module_mm": 2}, "last": "pair.face_width_mm"},
        {"changes": {"pair.module_mm": 2}, "last": ["pair.module_mm", "pair.x"]},
        {"changes": {"name": 2}, "last": "name"},
        {"changes": {"pair.x": 0.1}, "last": "pair.x"},
        {"changes": {"pair.teeth": 2}, "last": "pair.teeth"},
        {"changes": {"pair.teeth[2]": 2}, "last": "pair.teeth[2]"},
        *(
            {"changes": {"pair.module_mm": value}, "last": "pair.module_mm"}
            for value in ("2", True, None, [2], float("nan"), float("inf"), 1e300, 10**400)
        ),
    ],
)
def test_only_numbers_of_the_file_are_followed(server: Server, asked: dict[str, object]) -> None:
    answer, content = ask(server, "follow", json.dumps(asked).encode())
    assert answer.status == 400
    assert json.loads(content)["error"]


@pytest.mark.parametrize("method", ["PUT", "DELETE", "OPTIONS", "HEAD", "PATCH", "TRACE", "X"])
def test_other_methods_do_nothing(server: Server, method: str) -> None:
    assert ask(server, "", method=method)[0].status == 501


def test_a_number_is_followed_as_the_library_builds_it(server: Server) -> None:
    answer, content = ask(server, "follow", WISH)
    reply = json.loads(content)
    assert (answer.status, reply["error"]) == (200, "")
    assert reply["changes"] == {"pair.module_mm": 2.5}
    left, _, right, _ = reply["document"]["scene"]["box"]
    assert right - left == pytest.approx(2 * 2.5 * 12 + 2 * 2.5, abs=0.1)  # both tip circles
    assert "charts" not in reply["document"]
    exact = WISH[:-1] + b', "exact": true}'
    assert json.loads(ask(server, "follow", exact)[1])["document"]["charts"]


def test_events_tell_the_number_of_the_state(view: tuple[Server, Shown]) -> None:
    server, shown_ = view
    connection = HTTPConnection("127.0.0.1", server.server_port, timeout=SECONDS)
    connection.request("GET", f"/{server.token}/events")
    answer = connection.getresponse()
    assert answer.headers["Content-Type"] == "text/event-stream"
    number = shown_.session.state.number
    lines = [answer.fp.readline() for _ in range(4)]
    assert lines[:3] == [b"event: run\n", f"data: {server.run}\n".encode(), b"\n"]
    assert lines[3] == f"data: {number}\n".encode()
    shown_.refresh()
    assert answer.fp.readline() == b"\n"
    assert int(answer.fp.readline().removeprefix(b"data: ")) > number
    connection.close()


def test_a_file_that_was_never_good_is_told_of(tmp_path: Path) -> None:
    file = tmp_path / "</script><b>.toml".replace("/", "")
    file.write_text('kind = "gear-pair"\nname = "a"\n[law]\ntype = "</script><script>x"\n')
    with served(file) as (server, view):
        answer, content = ask(server, "")
        assert answer.status == 200
        assert content.count(b"<script") == 2
        assert b"\\u003c/script>" in content
        told = json.loads(ask(server, "document")[1])
        assert told["document"] is None
        assert "[pair]" in told["error"] or "pair" in told["error"]
        assert view.session.state.document is None


def test_a_port_in_use_is_refused_with_how_to_take_a_free_one(tmp_path: Path) -> None:
    file = tmp_path / "wheels.toml"
    file.write_text(DESIGN)
    with shown(file) as view, Server(view.session) as first:
        with pytest.raises(DesignError) as caught:
            Server(view.session, first.server_port)
        (problem,) = caught.value.problems
        assert str(first.server_port) in problem.message
        assert problem.hint == "without --port a free one is taken"
        with Server(view.session) as second:
            assert second.server_port != first.server_port


@pytest.mark.parametrize("port", [-1, 65536])
def test_what_is_no_port_is_refused(tmp_path: Path, port: int) -> None:
    with shown(tmp_path / "x") as view, pytest.raises(DesignError, match="is not a port number"):
        Server(view.session, port)


def test_only_this_computer_is_listened_to(server: Server) -> None:
    with socket.socket() as probe:
        assert probe.connect_ex(("127.0.0.1", server.server_port)) == 0
    with socket.socket() as probe:
        probe.settimeout(1.0)
        assert probe.connect_ex(("127.0.0.2", server.server_port)) != 0
