"""The server on this machine: what it answers, and whom it refuses."""

import json
import threading
from http.client import HTTPConnection

import numpy as np
import pytest

from exactfold.app.viewer import view_server
from exactfold.app.viewer.coding import decoded_frames
from exactfold.app.viewer.server import HEADER
from exactfold.branches import find_branch


@pytest.fixture(scope="module")
def server():
    with view_server("two-vertex", frames=3) as found:
        thread = threading.Thread(target=found.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        yield found
        found.shutdown()
        thread.join()


def get(server, path, **headers):
    connection = HTTPConnection("127.0.0.1", server.server_port, timeout=60)
    connection.request("GET", path, headers={HEADER: "1"} | headers)
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, body


def test_it_listens_on_the_loopback_address_only(server):
    assert server.server_address[0] == "127.0.0.1"
    assert server.address == f"http://127.0.0.1:{server.server_port}/"


@pytest.mark.parametrize(
    ("failure", "said"),
    [(ConnectionResetError(), False), (BrokenPipeError(), False), (ValueError("a defect"), True)],
)
def test_a_browser_that_leaves_early_is_no_failure(server, capfd, failure, said):
    try:
        raise failure
    except type(failure):
        server.handle_error(None, ("127.0.0.1", 0))
    assert (type(failure).__name__ in capfd.readouterr().err) == said


def test_the_page_lists_branches_without_motions(server):
    status, body = get(server, "/")
    assert status == 200
    assert b'"served":true' in body
    assert b"connect-src 'self'" in body
    assert body.count(b'"motion":null') == 4


def test_motions_and_branches_come_on_demand(server):
    status, body = get(server, "/motion?way=2")
    listed = json.loads(body)
    assert (status, listed["signs"], listed["motion"]["frames"]) == (200, "+-", 3)
    status, body = get(server, "/branch?signs=%2B-")
    found = json.loads(body)
    assert status == 200
    assert found["letters"] == listed["letters"] == find_branch("two-vertex", "+-").assignment_text
    frames = [decoded_frames(way["motion"]) for way in (found, listed)]
    assert np.allclose(*frames, atol=1e-6)


@pytest.mark.parametrize("others", [["evil.example"], [None], [], ["", ""]])
def test_of_several_hosts_none_wins(server, others):
    """None stands for the server itself: also its own name is not to be there twice."""
    own = f"127.0.0.1:{server.server_port}"
    hosts = [own if host is None else host for host in others]
    for order in ([own, *hosts], [*hosts, own]) if others else ([],):
        connection = HTTPConnection("127.0.0.1", server.server_port, timeout=60)
        connection.putrequest("GET", "/", skip_host=True)
        for host in order:
            connection.putheader("Host", host)
        connection.endheaders()
        assert connection.getresponse().status == 403
        connection.close()


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("/branch?signs=%2B-%2B", "3 signs for 2 vertices"),
        ("/branch", "0 signs for 2 vertices"),
        ("/motion?way=4", "there is no way 4"),
        ("/motion?way=x", "'x' is not the number of a way"),
        ("/motion?way=0_1", "'0_1' is not the number of a way"),
    ],
)
def test_errors_are_told(server, path, message):
    status, body = get(server, path)
    assert status == 422
    assert json.loads(body)["error"].startswith(message)


def test_other_names_of_this_machine_and_other_pages_are_refused(server):
    assert get(server, "/", Host="evil.example")[0] == 403
    assert get(server, "/motion?way=0", Host=f"evil.example:{server.server_port}")[0] == 403
    assert get(server, "/", Host=f"localhost:{server.server_port}")[0] == 200
    assert get(server, "/../etc/passwd")[0] == 404
    connection = HTTPConnection("127.0.0.1", server.server_port, timeout=60)
    connection.request("GET", "/motion?way=0")  # without the header of the page
    assert connection.getresponse().status == 403
    connection.close()
