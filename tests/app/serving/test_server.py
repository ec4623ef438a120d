"""The server on this machine: what it answers, and whom it refuses."""

import base64
import json
import re
import socket
import threading
import time
from http.client import HTTPConnection

import numpy as np
import pytest

from exactfold.app.serving import server as module
from exactfold.app.serving import view_server
from exactfold.app.serving.server import HEADER, MOST_REQUESTS
from exactfold.app.viewer.coding import decoded_frames
from exactfold.branches import count_branches, find_branch
from exactfold.errors import UsageError
from exactfold.pattern.data import example_path


@pytest.fixture(scope="module")
def server():
    with view_server("two-vertex", frames=3, limit=30) as found:
        thread = threading.Thread(target=found.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        yield found
        found.shutdown()
        thread.join()


def asked(server, method, path, body=b"", headers=None, host=None):
    """The status, the headers and the body of an answer."""
    connection = HTTPConnection("127.0.0.1", server.server_port, timeout=60)
    connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
    connection.putheader("Host", host or f"127.0.0.1:{server.server_port}")
    if method == "POST":
        connection.putheader("Content-Length", str(len(body)))
    for name, value in (headers or {}).items():
        connection.putheader(name, value)
    connection.endheaders(body or None)
    answer = connection.getresponse()
    found = answer.status, dict(answer.getheaders()), answer.read()
    connection.close()
    return found


def page(server, **keys):
    return asked(server, "GET", f"/{server.key}/", **keys)


def post(server, path, request, **headers):
    body = request if isinstance(request, bytes) else json.dumps(request).encode()
    return asked(server, "POST", f"/{server.key}/{path}", body, {HEADER: "1"} | headers)


def lines(server, path, request):
    status, _, body = post(server, path, request)
    assert status == 200
    return [json.loads(line) for line in body.splitlines() if line]


def test_it_listens_on_the_loopback_address_only_and_its_address_has_a_secret(server):
    assert server.server_address[0] == "127.0.0.1"
    assert server.address == f"http://127.0.0.1:{server.server_port}/{server.key}/"
    assert len(server.key) >= 24
    with view_server() as other:
        assert other.key != server.key


def test_the_page_comes_with_a_strict_policy(server):
    status, headers, body = page(server)
    assert status == 200
    assert b'"begins":true' in body
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "connect-src 'self'" in policy
    assert not re.search(r"unsafe|\*|https?:", policy)
    text = body.decode()
    scripts = re.findall(r"<script(?: type=\"module\")?>(.*?)</script>", text, re.DOTALL)
    assert len(scripts) == 2
    assert re.findall(r"script-src ([^;]*);", policy)[0].count("'sha256-") == 2
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["X-Frame-Options"] == "DENY"
    assert headers["Referrer-Policy"] == "no-referrer"
    assert "Access-Control-Allow-Origin" not in headers


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "evil.example:80", ""]
)
def test_other_names_of_this_machine_are_refused(server, host):
    status, _, body = page(server, host=host or " ")
    assert (status, body) == (403, b"this server only answers this machine")


def test_localhost_is_a_name_of_this_machine(server):
    assert page(server, host=f"localhost:{server.server_port}")[0] == 200


@pytest.mark.parametrize("others", [["evil.example"], [None], [], ["", ""]])
def test_of_several_hosts_none_wins(server, others):
    """None stands for the server itself: also its own name is not to be there twice."""
    own = f"127.0.0.1:{server.server_port}"
    hosts = [own if host is None else host for host in others]
    for order in ([own, *hosts], [*hosts, own]) if others else ([],):
        connection = HTTPConnection("127.0.0.1", server.server_port, timeout=60)
        connection.putrequest("GET", f"/{server.key}/", skip_host=True)
        for host in order:
            connection.putheader("Host", host)
        connection.endheaders()
        assert connection.getresponse().status == 403
        connection.close()


@pytest.mark.parametrize("path", ["/", "//", "/wrong/", "/WRONG", "/%C3%BC/", "x"])
def test_without_the_secret_there_is_no_page(server, path):
    status, _, body = asked(server, "GET", path.replace("WRONG", server.key[:-1]))
    assert status == 403
    assert b"open the whole address" in body
    assert asked(server, "POST", path, b"{}", {HEADER: "1"})[0] == 403


@pytest.mark.parametrize("path", ["x", "../etc/passwd", "open", "index.html"])
def test_only_the_page_is_at_an_address(server, path):
    assert asked(server, "GET", f"/{server.key}/{path}")[0] == 404
    if path != "open":
        assert post(server, path, {})[0] == 404


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_other_sites_may_neither_open_nor_ask(server, site):
    assert page(server, headers={"Sec-Fetch-Site": site})[0] == 403
    assert post(server, "open", {}, **{"Sec-Fetch-Site": site})[0] == 403


@pytest.mark.slow
def test_a_person_may_open_the_page_but_a_post_is_of_the_page(server):
    assert page(server, headers={"Sec-Fetch-Site": "none"})[0] == 200
    assert post(server, "follow", {}, **{"Sec-Fetch-Site": "none"})[0] == 403
    assert post(server, "follow", {}, **{"Sec-Fetch-Site": "same-origin"})[0] == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1", "own,own"])
def test_other_origins_are_refused(server, origin):
    own = f"http://127.0.0.1:{server.server_port}"
    origin = origin.replace("own", own)
    assert page(server, headers={"Origin": origin})[0] == 403
    status, _, body = post(server, "open", {}, Origin=origin)
    assert (status, body) == (403, b"another site may not ask this server")
    assert post(server, "follow", {}, Origin=own)[0] == 200


def test_a_form_of_another_page_cannot_post(server):
    """Without permission, a form or a script elsewhere cannot send the header of the page."""
    status, _, body = asked(server, "POST", f"/{server.key}/open", b"{}")
    assert (status, body) == (403, b"only the page itself may ask this")
    for method in ("OPTIONS", "PUT", "DELETE", "HEAD"):
        status, headers, _ = asked(server, method, f"/{server.key}/open")
        assert status == 501
        assert not [name for name in headers if name.startswith("Access-Control")]


@pytest.mark.parametrize(
    ("request_body", "status", "said"),
    [
        (b"[1]", 400, b"not a JSON object"),
        (b"{", 400, b"not a JSON object"),
        (b"[" * 100_000, 400, b"not a JSON object"),
        ({"data": "%%%"}, 400, b"base64"),
        ({"data": 7}, 400, b"a text is not a text"),
        ({"fold": {}, "move": {}}, 400, b"vertex"),
        ({"fold": "/etc/passwd"}, 400, b"a sheet of the page is a JSON object"),
        ({"fold": 5}, 400, b"a sheet of the page is a JSON object"),
        ({"fold": {}, "move": {"vertex": True, "x": 0, "y": 0}}, 400, b"not a whole number"),
        (b'{"fold": {}, "move": {"vertex": 1, "x": Infinity, "y": 0}}', 400, b"not a number"),
    ],
)
def test_requests_that_the_page_never_sends_are_refused(server, request_body, status, said):
    answer = post(server, "open", request_body)
    assert answer[0] == status
    assert said in answer[2]


def raw(server, text):
    """What comes back for bytes on the wire, until the server closes."""
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=10) as wire:
        wire.sendall(text)
        parts = []
        try:
            while part := wire.recv(65536):
                parts.append(part)
        except ConnectionResetError:
            pass
    return b"".join(parts)


def head(server, *rows):
    own = f"Host: 127.0.0.1:{server.server_port}"
    return "\r\n".join([f"POST /{server.key}/open HTTP/1.1", own, f"{HEADER}: 1", *rows, "", ""])


def test_a_path_of_other_bytes_has_no_secret(server):
    own = f"Host: 127.0.0.1:{server.server_port}"
    answer = raw(server, f"GET /\xfc/ HTTP/1.1\r\n{own}\r\n\r\n".encode("latin-1"))
    assert b" 403 " in answer.split(b"\r\n")[0]


@pytest.mark.parametrize(
    ("rows", "status"),
    [
        (("Content-Length: 99999999",), b" 413 "),
        (("Content-Length: 9999999999999999999999",), b" 413 "),
        ((), b" 411 "),
        (("Content-Length: -1",), b" 411 "),
        (("Content-Length: 1_0",), b" 411 "),
        (("Content-Length: 2", "Content-Length: 3"), b" 411 "),
        (("Transfer-Encoding: chunked",), b" 411 "),
    ],
)
def test_sizes_are_limited_before_anything_is_read(server, rows, status):
    answer = raw(server, head(server, *rows).encode())
    assert status in answer.split(b"\r\n")[0]


def test_a_name_is_no_path(server, tmp_path):
    """The name of a dropped file is only shown: no other file of the machine can be read by it."""
    secret = tmp_path / "secret.cp"
    secret.write_text("1 0 0 1 0\n", encoding="utf-8")
    coded = base64.b64encode(b"nothing").decode()
    for request in ({"name": str(secret), "data": coded}, {"name": str(secret)}):
        first, *_ = lines(server, "open", {"session": "five"} | request)
        assert first.get("name", "") == ("two-vertex" if "data" not in request else "")


def test_who_sends_nothing_is_cut_off(server, monkeypatch):
    monkeypatch.setattr(module._Handler, "timeout", 0.3)
    assert raw(server, head(server, "Content-Length: 10").encode() + b"{") == b""


def test_too_many_requests_at_once_are_turned_away(server):
    """The room for requests is taken first, which waits for those of the tests before this one."""
    for _ in range(MOST_REQUESTS):
        assert server._room.acquire(timeout=60)
    try:
        with pytest.raises(ConnectionError):
            page(server)
    finally:
        server._room.release(MOST_REQUESTS)
    assert page(server)[0] == 200


def test_a_request_that_is_answered_makes_room_again(server):
    for _ in range(MOST_REQUESTS + 1):
        assert page(server)[0] == 200


@pytest.mark.parametrize(
    ("failure", "said"),
    [(ConnectionResetError(), False), (TimeoutError(), False), (ValueError("a defect"), True)],
)
def test_a_browser_that_leaves_early_is_no_failure(server, capfd, failure, said):
    try:
        raise failure
    except type(failure):
        server.handle_error(None, ("127.0.0.1", 0))
    assert (type(failure).__name__ in capfd.readouterr().err) == said


def test_ports_and_frames_out_of_range_are_refused():
    with pytest.raises(UsageError, match="port 65536"):
        view_server("two-vertex", port=65536)
    with pytest.raises(UsageError, match="1 frames"):
        view_server("two-vertex", frames=1)


@pytest.mark.slow
def test_who_leaves_ends_the_work_for_him():
    """A page that is closed does not keep a process busy."""
    with view_server("bird-base", limit=60) as found:
        thread = threading.Thread(target=found.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        try:
            before = {worker._process.pid for worker in found._listing}
            body = b'{"session": "gone"}'
            with socket.create_connection(("127.0.0.1", found.server_port), timeout=60) as wire:
                rows = f"Content-Length: {len(body)}"
                wire.sendall(head(found, rows).encode() + body)
                assert b"200" in wire.recv(4096)
            for _ in range(300):
                if {worker._process.pid for worker in found._listing} != before:
                    break
                time.sleep(0.1)
            assert len({worker._process.pid for worker in found._listing} - before) == 1
            assert [worker for worker in found._listing if worker.session == "gone"] == []
        finally:
            found.shutdown()
            thread.join()


# --- answers -------------------------------------------------------------------------------------


def test_the_sheet_of_the_command_is_read_listed_and_followed(server):
    answers = lines(server, "open", {"session": "one"})
    count = count_branches("two-vertex")
    kinds = ["read", "listed", *["way"] * 4, "folded", "done"]
    assert [answer["kind"] for answer in answers] == kinds
    document = answers[1]["document"]
    assert document["answer"].startswith("4 ways to start folding - PROVED")
    assert document["freedom"] == "degrees of freedom: 1"
    assert [way["signs"] for way in document["ways"]] == [b.sign_text for b in count]
    assert [answer["way"] for answer in answers[2:-2]] == [0, 1, 2, 3]
    assert answers[2]["found"]["motion"]["frames"] == 3


def test_ways_are_followed_by_number_or_signs_in_the_session_of_the_sheet(server):
    lines(server, "open", {"session": "two"})
    [by_number, _] = lines(server, "follow", {"session": "two", "way": 2})
    [by_signs, _] = lines(server, "follow", {"session": "two", "signs": "+-"})
    frames = [decoded_frames(found["motion"]) for found in (by_number["found"], by_signs["branch"])]
    assert np.allclose(*frames, atol=1e-6)
    letters = by_signs["branch"]["letters"]
    assert letters == find_branch("two-vertex", "+-").assignment_text
    for request, said in (
        ({"way": 9}, "there is no way 9"),
        ({"signs": "+-+"}, "3 signs for 2 vertices"),
    ):
        assert lines(server, "follow", {"session": "two"} | request)[0]["error"].startswith(said)
    [gone, _] = lines(server, "follow", {"session": "never opened", "way": 0})
    assert gone["error"] == "the sheet is no longer open here: open it again"


@pytest.mark.slow
def test_a_dropped_drawing_is_read_and_what_was_mended_is_told(server):
    path = example_path("bird-base")
    data = base64.b64encode(path.read_bytes()).decode()
    answers = lines(server, "open", {"session": "three", "name": path.name, "data": data})
    assert answers[0]["name"] == path.name
    assert any("cut there" in line for line in answers[0]["read"])
    assert "24 lines" in answers[0]["brief"]
    assert answers[1]["document"]["drawn"] == {"way": 0, "mirrored": False}
    assert answers[2]["way"] == 0


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("sheet.fold", b"{}", "sheet.fold"),
        ("../../x.svg", b"<svg", "x.svg"),
        ("bomb.svg", b'<!DOCTYPE a [<!ENTITY x "y">]><svg>&x;</svg>', ""),
        ("noise.cp", bytes(range(256)), ""),
        ("", b"", ""),
    ],
)
def test_files_that_are_no_drawings_get_a_sentence(server, name, data, said):
    coded = base64.b64encode(data).decode()
    [answer, done] = lines(server, "open", {"session": "four", "name": name, "data": coded})
    assert (answer["kind"], done["kind"]) == ("error", "done")
    assert said in answer["error"]
    assert "defect" not in answer["error"]
    assert "exactfold-" not in answer["error"]  # the name of a temporary folder


@pytest.mark.slow
def test_work_that_takes_too_long_is_ended_and_the_next_is_done():
    with view_server("two-vertex", frames=3, limit=0.001) as found:
        thread = threading.Thread(target=found.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        try:
            answers = lines(found, "open", {"session": "x"})
            assert answers[-2:] == [
                {"kind": "error", "error": "stopped after 0.001 seconds"},
                {"kind": "done"},
            ]
            found.limit = 30
            assert lines(found, "open", {"session": "x"})[0]["kind"] == "read"
        finally:
            found.shutdown()
            thread.join()
