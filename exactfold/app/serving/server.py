"""The server on this machine: it gives the page, and its processes do what the page asks for.

It answers a request only if all of these hold: the connection comes from this machine; the one Host
header has the name under which the page runs; the path begins with a secret that the server made
when it started; the browser does not say that another site asks; and, for everything but the page
itself, the request carries a header that other pages may not send.
"""

from __future__ import annotations

import base64
import binascii
import hmac
import json
import secrets
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import replace
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from math import isfinite
from typing import Any, Final
from urllib.parse import urlsplit

from exactfold.app.pictures.film import MOST_PICTURES
from exactfold.app.serving.tasks import FREE, Answer, Film, Follow, Move, Open, Task
from exactfold.app.serving.worker import Worker
from exactfold.app.viewer.document import FRAMES, MOST_FRAMES
from exactfold.app.viewer.page import page_policy, start_page
from exactfold.errors import UsageError
from exactfold.pattern.loading import PatternLike
from exactfold.pattern.reading import PLAIN, Reading

HEADER: Final = "X-Exactfold"
"""The page sends this header with each request; other pages may not send it without permission."""
LIMIT: Final = 60.0
"""The seconds for one task, unless another limit is asked for."""
MOST_BYTES: Final = 8 << 20
"""Of a drawing or another request."""
MOST_FILM_BYTES: Final = 64 << 20
MOST_REQUESTS: Final = 32
"""Requests that are answered at the same time; others are turned away."""
_LOOPBACK: Final = "127.0.0.1"
_MOST_PORT: Final = 65535
_PATIENCE: Final = 15.0
"""Seconds without a byte after which a connection is closed, and for which a task waits."""
_BUSY: Final = "the server is busy with other sheets; try again in a moment"
_HEADERS: Final = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}


def view_server(
    sheet: PatternLike | None = None,
    *,
    name: str | None = None,
    reading: Reading = PLAIN,
    branches: Sequence[str] | None = None,
    frames: int = FRAMES,
    proving: bool = False,
    port: int = 0,
    limit: float = LIMIT,
) -> ViewServer:
    """A server on the loopback address with the page, which opens `sheet` if one is given.

    `serve_forever` runs it, `address` is where it runs, and `server_close` ends its processes. Port
    0 means any free port. Drawings can be dropped into the page. What takes longer than `limit`
    seconds is ended. The other arguments are those of `view_document`. Raises `UsageError` for a
    number that is not a port and for other numbers out of range, and `OSError` for a port that is
    in use.

    >>> with view_server("two-vertex") as server:
    ...     server.address.startswith("http://127.0.0.1:")
    True
    """
    if not 0 <= port <= _MOST_PORT:
        raise UsageError(f"port {port}: give a number from 0 to {_MOST_PORT}")
    if not 2 <= frames <= MOST_FRAMES:
        raise UsageError(
            f"{frames} frames: a motion in a page needs at least 2 and at most {MOST_FRAMES}"
        )
    title = name or (sheet if isinstance(sheet, str) else "crease pattern")
    start = Open(
        title if sheet is not None else "",
        sheet,
        reading=reading,
        branches=None if branches is None else tuple(branches),
        frames=frames,
        proving=proving,
        limit=limit,
    )
    return ViewServer(start, port)


class ViewServer(ThreadingHTTPServer):
    """Answers the requests of the page, and no others.

    Two processes list the ways of sheets, and one answers while a vertex is moved.
    """

    daemon_threads = True

    def __init__(self, start: Open, port: int) -> None:
        self.start, self.limit = start, start.limit
        self.key = secrets.token_urlsafe(18)
        self._room = threading.Semaphore(MOST_REQUESTS)
        super().__init__((_LOOPBACK, port), _Handler)
        try:
            self._listing, self._live = [Worker(), Worker()], [Worker()]
        except BaseException:
            super().server_close()
            raise
        self.page = start_page(start.name, begins=start.sheet is not None).encode("utf-8")

    @property
    def address(self) -> str:
        """The address of the page; it contains the secret."""
        return f"http://{_LOOPBACK}:{self.server_port}/{self.key}/"

    @property
    def hosts(self) -> tuple[str, ...]:
        """The names by which a browser on this machine asks for the page."""
        return tuple(f"{name}:{self.server_port}" for name in (_LOOPBACK, "localhost"))

    def server_close(self) -> None:
        """Close the socket and end the processes."""
        super().server_close()
        for worker in (*self._listing, *self._live):
            worker.close()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Report an error, unless a browser has left before its answer was complete."""
        if not isinstance(sys.exception(), ConnectionError | TimeoutError):
            super().handle_error(request, client_address)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Answer a request in a thread, or close it if too many are being answered."""
        if not self._room.acquire(blocking=False):
            self.shutdown_request(request)
            return
        try:
            super().process_request(request, client_address)
        except BaseException:
            # Ctrl-C may come when the thread has begun, which makes room as well: the server ends.
            self._room.release()
            raise

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Answer a request, and make room for another one."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._room.release()

    @contextmanager
    def worker(self, task: Task, session: str) -> Iterator[Worker]:
        """A process for a task, held until the block ends; raises `UsageError` if all are busy.

        A way is followed by the process that has the sheet of the session open.
        """
        workers = self._live if isinstance(task, Open) and task.live else self._listing
        if isinstance(task, Follow):
            workers = [one for one in (*self._listing, *self._live) if one.session == session]
            if not workers:
                raise UsageError("the sheet is no longer open here: open it again")
        held = next((one for one in workers if one.lock.acquire(blocking=False)), None)
        if held is None:
            if not workers[0].lock.acquire(timeout=_PATIENCE):
                raise UsageError(_BUSY)
            held = workers[0]
        try:
            if isinstance(task, Open):
                for other in (*self._listing, *self._live):
                    if other.session == session:
                        other.session = ""
                held.session = session
            yield held
        finally:
            held.lock.release()


class _RefusedError(Exception):
    """A request that is not answered, with the status and the reason."""

    def __init__(self, status: HTTPStatus, reason: str) -> None:
        super().__init__(reason)
        self.status = status


class _Handler(BaseHTTPRequestHandler):
    server: ViewServer
    timeout = _PATIENCE
    server_version = "exactfold"
    sys_version = ""

    def do_GET(self) -> None:
        """Give the page."""
        try:
            self._check_sender(("none", "same-origin"))
            if self._path() != "":
                raise _RefusedError(HTTPStatus.NOT_FOUND, "there is nothing at this address")
        except _RefusedError as refused:
            self._refuse(refused)
            return
        self._send(HTTPStatus.OK, self.server.page, "text/html; charset=utf-8")

    def do_POST(self) -> None:
        """Do what the page asks for, and send the answers as they come, one in each line."""
        try:
            self._check_sender(("same-origin",))
            if HEADER not in self.headers:
                raise _RefusedError(HTTPStatus.FORBIDDEN, "only the page itself may ask this")
            path = self._path()
            request = self._body(MOST_FILM_BYTES if path == "film" else MOST_BYTES)
            task = _task(path, request, self.server)
        except _RefusedError as refused:
            self._refuse(refused)
            return
        except (UsageError, KeyError, TypeError, ValueError) as error:
            self._refuse(_RefusedError(HTTPStatus.BAD_REQUEST, f"not a request: {error}"))
            return
        self._answer(task, str(request.get("session", "")))

    def _check_sender(self, sites: Sequence[str]) -> None:
        """Refuse whatever does not come from the page itself, or from a person who opens it."""
        hosts = self.headers.get_all("Host", [])
        if len(hosts) != 1 or hosts[0] not in self.server.hosts:
            raise _RefusedError(HTTPStatus.FORBIDDEN, "this server only answers this machine")
        origins = self.headers.get_all("Origin", [])
        if origins and origins != [f"http://{hosts[0]}"]:
            raise _RefusedError(HTTPStatus.FORBIDDEN, "another site may not ask this server")
        if any(site not in sites for site in self.headers.get_all("Sec-Fetch-Site", [])):
            raise _RefusedError(HTTPStatus.FORBIDDEN, "another site may not ask this server")

    def _path(self) -> str:
        """What is asked for, without the secret; refuses a path without it."""
        _, key, *rest = [*urlsplit(self.path).path.split("/", 2), ""]
        if not hmac.compare_digest(key.encode("utf-8"), self.server.key.encode("utf-8")):
            raise _RefusedError(
                HTTPStatus.FORBIDDEN, "open the whole address that `exactfold serve` printed"
            )
        return rest[0]

    def _body(self, most: int) -> dict[str, Any]:
        """The JSON object of a request; refuses one that is too long or has no length."""
        lengths = self.headers.get_all("Content-Length", [])
        if len(lengths) != 1 or not (lengths[0].isascii() and lengths[0].isdigit()):
            raise _RefusedError(
                HTTPStatus.LENGTH_REQUIRED, "the request does not say how long it is"
            )
        if len(lengths[0]) > 12 or int(lengths[0]) > most:
            self.close_connection = True
            raise _RefusedError(
                HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
                f"the request is too large: at most {most >> 20} MB are read",
            )
        text = self.rfile.read(int(lengths[0]))
        try:
            found = json.loads(text)
        except (ValueError, RecursionError):
            found = None
        if not isinstance(found, dict):
            raise _RefusedError(HTTPStatus.BAD_REQUEST, "the request is not a JSON object")
        return found

    def _answer(self, task: Task, session: str) -> None:
        self.send_response(HTTPStatus.OK)
        self._end_headers("application/x-ndjson")
        try:
            with (
                self.server.worker(task, session) as worker,
                closing(worker.run(task, self.server.limit)) as answers,
            ):
                for answer in answers:
                    self._line(answer)
        except UsageError as error:
            self._line({"kind": "error", "error": str(error)})
        with suppress(OSError):
            self._line({"kind": "done"})

    def _line(self, answer: Answer | None) -> None:
        """One line; an empty one only finds out whether the page still listens."""
        text = "" if answer is None else json.dumps(answer, allow_nan=False)
        self.wfile.write(text.encode("utf-8") + b"\n")
        self.wfile.flush()

    def _refuse(self, refused: _RefusedError) -> None:
        self._send(refused.status, str(refused).encode("utf-8"), "text/plain; charset=utf-8")

    def _send(self, status: HTTPStatus, body: bytes, kind: str) -> None:
        self.send_response(status)
        self.send_header("Content-Length", str(len(body)))
        self._end_headers(kind)
        self.wfile.write(body)

    def _end_headers(self, kind: str) -> None:
        self.send_header("Content-Type", kind)
        self.send_header("Content-Security-Policy", page_policy(served=True, framed=True))
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.end_headers()

    def log_message(self, format: str, *args: object) -> None:
        """Write nothing, because the page shows what went wrong."""


def _task(path: str, request: dict[str, Any], server: ViewServer) -> Task:
    """What a request asks for; raises an error for a request that is not one of the page."""
    if path == "open":
        return _open(request, server.start)
    if path == "follow":
        way = request.get("way")
        return Follow(None if way is None else _whole(way, "way"), _text(request.get("signs", "")))
    if path == "film":
        pictures = request["pictures"]
        if not isinstance(pictures, list) or len(pictures) > MOST_PICTURES:
            raise UsageError(f"an animation has at most {MOST_PICTURES} pictures")
        return Film(tuple(map(_decoded, pictures)), _number(request["seconds"]))
    raise _RefusedError(HTTPStatus.NOT_FOUND, "there is nothing at this address")


def _open(request: dict[str, Any], start: Open) -> Open:
    """The task to open the sheet of the command, a dropped file, or a sheet of the page."""
    move = None
    if request.get("move") is not None:
        given = request["move"]
        move = Move(
            _whole(given["vertex"], "vertex"),
            _number(given["x"]),
            _number(given["y"]),
            _whole(given.get("grid", FREE), "grid"),
        )
    fresh = replace(start, sheet=None, branches=None)
    name = _text(request.get("name", ""))[:200]
    if request.get("data") is not None:
        data = _decoded(request["data"])
        return replace(fresh, name=name, data=data)
    if request.get("fold") is not None:
        if not isinstance(request["fold"], dict):
            raise UsageError("a sheet of the page is a JSON object")
        text = json.dumps(request["fold"])
        live = request.get("live") is True
        return replace(fresh, name=name, sheet=text, reading=PLAIN, move=move, live=live)
    return start


def _whole(value: Any, what: str) -> int:
    if not isinstance(value, int) or isinstance(value, bool):
        raise UsageError(f"the {what} is not a whole number")
    return value


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise UsageError("a number is not a number")
    return float(value)


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise UsageError("a text is not a text")
    return value


def _decoded(value: Any) -> bytes:
    try:
        return base64.b64decode(_text(value), validate=True)
    except binascii.Error:
        raise UsageError("a file is not coded in base64") from None
