"""A server on this machine for sheets with too many branches for one file."""

from __future__ import annotations

import json
import sys
import threading
from collections.abc import Sequence
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, Final
from urllib.parse import parse_qs, urlsplit

from exactfold._support.progress import Progress
from exactfold.app.viewer.document import FRAMES, Known
from exactfold.app.viewer.page import view_page
from exactfold.app.viewer.ways import Following, Way, branch_way
from exactfold.branches.counting.find import BranchFinder, branch_finder
from exactfold.branches.values.branch import Branch
from exactfold.errors import ExactfoldError, NumberError, UsageError
from exactfold.exact.numbers import parse_whole
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike

HEADER: Final = "X-Exactfold"
"""The page sends this header with each request; other pages may not send it without permission."""
_LOOPBACK: Final = "127.0.0.1"
_MOST_PORT: Final = 65535


def view_server(
    sheet: PatternLike,
    *,
    name: str | None = None,
    branches: Sequence[str | Branch] | None = None,
    ways: Sequence[int] | None = None,
    frames: int = FRAMES,
    proving: bool = False,
    port: int = 0,
    progress: Progress | None = None,
) -> ViewServer:
    """A server on the loopback address whose page requests branches when they are looked at.

    `serve_forever` runs it, and `address` is where it runs; port 0 means any free port. Branches
    are listed as by `view_document`. None is followed before the page asks for it. Any other branch
    is found by its signs. Raises the errors of `view_document`, `UsageError` for a number that is
    not a port, and `OSError` for a port that is in use.

    >>> with view_server("two-vertex") as server:
    ...     server.address.startswith("http://127.0.0.1:")
    True
    """
    if not 0 <= port <= _MOST_PORT:
        raise UsageError(f"port {port}: give a number from 0 to {_MOST_PORT}")
    known = Known.of(
        sheet,
        name=name,
        branches=branches,
        ways=ways,
        frames=frames,
        proving=proving,
        progress=progress,
    )
    return ViewServer(known, port)


class ViewServer(ThreadingHTTPServer):
    """Answers the requests of one page; refuses requests that use another name for this machine.

    A browser sends the name that it asked for. A page from the network may make its own name
    resolve to the loopback address; the server refuses such requests.
    """

    daemon_threads = True

    def __init__(self, known: Known, port: int) -> None:
        self._known = known
        self._lock = threading.Lock()
        self._finder: BranchFinder | None = None
        document = known.document([way for way, _ in known.listed], served=True)
        self._page = view_page(document).encode("utf-8")
        super().__init__((_LOOPBACK, port), _Handler)

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"http://{_LOOPBACK}:{self.server_port}/"

    def is_ours(self, hosts: Sequence[str]) -> bool:
        """Whether a request has exactly one Host header, with the name by which the page uses the
        server.
        """
        ours = (f"{_LOOPBACK}:{self.server_port}", f"localhost:{self.server_port}")
        return len(hosts) == 1 and hosts[0] in ours

    @property
    def page(self) -> bytes:
        """The page as bytes."""
        return self._page

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Report an error, unless a browser has left before its answer was complete."""
        if not isinstance(sys.exception(), ConnectionError):
            super().handle_error(request, client_address)

    def motion(self, number: int) -> Way:
        """The motion of the way with this number, from 0 on; raises `UsageError` if there
        is none.
        """
        if not 0 <= number < len(self._known.listed):
            raise UsageError(f"there is no way {number}; the page has {len(self._known.listed)}")
        way, job = self._known.listed[number]
        if job is None:
            return way
        with self._lock:
            return {**way, **self._known.follower(job)}

    def branch(self, signs: str) -> Way:
        """The branch with these vertex signs, and its motion; raises the errors of
        `BranchFinder`.
        """
        pattern, following = self._known.opened.sheet, self._known.follower
        if not isinstance(pattern, CreasePattern) or not isinstance(following, Following):
            raise UsageError(
                "this sheet folds along modes of rigid panels, and modes have no vertex signs"
            )
        with self._lock:
            if self._finder is None:
                self._finder = branch_finder(pattern)
            branch = self._finder.find(self._finder.signs(signs, None))
            return {**branch_way(branch), **following(branch)}


class _Handler(BaseHTTPRequestHandler):
    server: ViewServer

    def do_GET(self) -> None:
        """Answer with the page, a motion, or a branch."""
        if not self.server.is_ours(self.headers.get_all("Host", [])):
            self._send(HTTPStatus.FORBIDDEN, b"this server only answers this machine", "text/plain")
            return
        url = urlsplit(self.path)
        if url.path == "/":
            self._send(HTTPStatus.OK, self.server.page, "text/html; charset=utf-8")
        elif url.path in ("/motion", "/branch"):
            self._way(url.path, {key: value[-1] for key, value in parse_qs(url.query).items()})
        else:
            self._send(HTTPStatus.NOT_FOUND, b"not found", "text/plain")

    def _way(self, path: str, query: dict[str, str]) -> None:
        if HEADER not in self.headers:
            self._send(HTTPStatus.FORBIDDEN, b"only the page itself may ask this", "text/plain")
            return
        status = HTTPStatus.OK
        answer: Way | dict[str, str]
        try:
            if path == "/motion":
                answer = self.server.motion(_whole(query.get("way", "")))
            else:
                answer = self.server.branch(query.get("signs", ""))
        except ExactfoldError as error:
            status = HTTPStatus.UNPROCESSABLE_ENTITY
            answer = {"error": str(error)}
        except Exception as error:
            status = HTTPStatus.INTERNAL_SERVER_ERROR
            answer = {"error": f"a defect of exactfold: {error!r}"}
        text = json.dumps(answer, allow_nan=False).encode("utf-8")
        self._send(status, text, "application/json")

    def _send(self, status: HTTPStatus, body: bytes, kind: str) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: object) -> None:
        """Write nothing, because the page shows what went wrong."""


def _whole(text: str) -> int:
    try:
        return parse_whole(text)
    except NumberError:
        raise UsageError(f"{text!r} is not the number of a way") from None
