"""Checker of compact certificates: one root per sign vector, standard library only.

    python compact_checker.py CERTIFICATE [WORKERS]

needs `checker.py` beside it and nothing else. The sheet and its curvature forms are rebuilt from
the file, and every claim is verified in integers, block by block, so that memory does not grow with
the file. Exit codes as in `checker.py`: 0 every claim holds, 1 some claim is not supported, 3 not a
compact certificate, 70 a worker process died, memory is short, or a defect of this program.

Why it is a proof: root number s lies in a box with exactly one zero (Krawczyk); on the whole box
the sign functional of the k-th foldable vertex is negative if bit k of s is set and positive if
not. So the 2^n zeros are pairwise different without any comparison, and by refined Bezout they are
all zeros of n quadrics in P^n, all simple and real.

The file is described in docs/compact-certificate.md.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import sys
import traceback
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context
from typing import IO, TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING or __package__:
    from exactfold import checker
else:
    import checker

FORMAT, VERSION = "exactfold compact certificate", 1
MOST_BITS, MOST_WIDTH, MOST_BLOCK, MOST_UNKNOWNS = 52, 8, 1 << 16, 40
MOST_LINE, MOST_DIGITS = 1 << 25, 4000  # bounds on the memory and the work one line can ask for
UNPROVED = 255  # radius byte of a root given under "exact"
COUNTS = "distinct with_multiplicity real nonreal true_branches"
MALFORMED = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
FACTS = "interior boundary folds degrees_of_freedom sha256"


# --- lines ---------------------------------------------------------------------------------------


def digest(previous: str, body: str) -> str:
    """The digest of a line: SHA-256 of the digest before it and its JSON text."""
    return hashlib.sha256((previous + body).encode()).hexdigest()


def lines(stream: IO[bytes]) -> Iterator[str]:
    """The JSON texts of a file, one a line; raises `checker.FormatError` where the chain breaks."""
    previous, number = "", 0
    while raw := stream.readline(MOST_LINE):
        number += 1
        body, _, found = raw.partition(b"\t")
        text = body.decode("ascii", "replace")
        previous = digest(previous, text)
        if not body.isascii() or found != f"{previous}\n".encode():
            raise checker.FormatError(f"line {number} is cut off or was altered")
        yield text


def read_object(text: str, what: str) -> dict[str, Any]:
    """One JSON object without floats or repeated keys."""
    try:
        data = checker.read_json(text)
    except checker.FormatError as error:
        raise checker.FormatError(f"{what}: {error}") from None
    if not isinstance(data, dict):
        raise checker.FormatError(f"{what} is not an object")
    return data


def read_header(text: str) -> dict[str, Any]:
    """The first line, if it is that of a compact certificate."""
    names = "format version pattern evidence provenance"
    return checker.read_document(text, FORMAT, VERSION, names)


# --- the sheet and its tests ---------------------------------------------------------------------


class Root(NamedTuple):
    """A box |x - center / 2^bits| <= radius / 2^bits."""

    center: list[int]
    radius: int
    bits: int

    def sign(self, row: Sequence[int]) -> int | None:
        """1 or -1 if the functional keeps that sign on the box, 0 if it is 0, else None."""
        value = row[-1] << self.bits
        reach = 0
        for c, m in zip(row, self.center, strict=False):  # the row is longer by its constant
            value += c * m
            reach += abs(c)
        reach *= self.radius
        if abs(value) > reach:
            return 1 if value > 0 else -1
        return 0 if value == reach == 0 else None


class Block(NamedTuple):
    """The decoded contents of one block, root after root."""

    first: int
    bits: int
    width: int
    centers: bytes
    radii: bytes
    folds: bytes
    exact: dict[int, tuple[Root, str]]

    def center(self, index: int, size: int) -> list[int]:
        """The centre of a root of the block, in units of 2^-bits."""
        width, start = self.width, index * size * self.width
        return [
            int.from_bytes(self.centers[k : k + width], "little", signed=True)
            for k in range(start, start + size * width, width)
        ]


class Chambers:
    """The sheet of a header, verified, with everything that tests its roots."""

    def __init__(self, header: dict[str, Any]) -> None:
        evidence = header["evidence"]
        checker.keys(evidence, "kind triangles chart block", "evidence")
        checker.require(evidence["kind"] == "chambers", "unknown kind of evidence")
        faces, vertices = (len(header["pattern"][k]) for k in ("triangles", "vertices"))
        checker.require(  # by Euler; so the boundary is short before it is looked at
            faces == 2 * vertices - 6 > 2, "the sheet has not four boundary vertices and an inner"
        )
        self.sheet, self.sha256 = checker.read_sheet(header["pattern"])
        checker.require(len(self.sheet.boundary) == 4, "the sheet has not D = 1")
        self.emptied = checker.check_triangles(self.sheet, evidence["triangles"])
        self.removed = len(self.sheet.interior) - len(self.emptied.interior)
        self.system = checker.BranchSystem(self.emptied, checker.read_chart(evidence["chart"]))
        self.size = self.system.size
        checker.require(0 < self.size <= MOST_UNKNOWNS, "the number of unknowns is out of range")
        self.block = checker.natural(evidence["block"], "block")
        checker.require(
            0 < self.block <= MOST_BLOCK and (1 << self.size) % self.block == 0,
            "the size of a block does not divide the number of roots",
        )
        self.blocks = (1 << self.size) // self.block
        self.krawczyk = checker.Krawczyk(self.system)
        self.vertex_rows = [
            self.system.row(self.emptied.sign_of_vertex(v)) for v in self.emptied.interior
        ]
        self.fold_rows = [self.system.row(self.emptied.bend(f)) for f in self.emptied.folds]
        self.letter_bytes = (len(self.fold_rows) + 7) // 8

    def claims(self) -> dict[str, Any]:
        """What a complete file proves."""
        counts = (1 << self.size, 1 << len(self.sheet.interior), 1 << self.size, 0, "proved")
        facts = (
            len(self.sheet.interior),
            len(self.sheet.boundary),
            len(self.sheet.folds),
            len(self.sheet.boundary) - 3,
            self.sha256,
        )
        keys = (*FACTS.split(), *COUNTS.split())
        return dict(zip(keys, (*facts, *counts), strict=True))

    def decode(self, text: str, number: int) -> Block:
        """The block of a line, which must be block `number`."""
        what = f"block {number}"
        data = read_object(text, what)
        checker.keys(data, "block bits width centers radii folds exact open", what)
        checker.require(
            type(data["block"]) is int and data["block"] == number,
            f"{what} is expected, but here is block {data['block']!a}",
        )
        bits, width = checker.natural(data["bits"], "bits"), checker.natural(data["width"], "width")
        checker.require(bits <= MOST_BITS and 0 < width <= MOST_WIDTH, f"{what} is out of range")
        first = number * self.block
        for entry in checker.items(data["open"], "open"):
            index, reason = checker.items(entry, "open root", 2)
            raise checker.CertificateError(f"root {first + index} is open: {reason!a}")
        parts = []
        for name, length in (("centers", self.size * width), ("radii", 1), ("folds", 0)):
            try:
                part = base64.b64decode(data[name], validate=True)
            except (binascii.Error, TypeError, ValueError):
                raise checker.CertificateError(f"{what}: {name} is not base 64") from None
            length = length or self.letter_bytes
            checker.require(len(part) == self.block * length, f"{what}: {name} has another length")
            parts.append(part)
        exact: dict[int, tuple[Root, str]] = {}
        for entry in checker.items(data["exact"], "exact"):
            checker.keys(entry, "root bits radius center assignment", "exact root")
            index = checker.natural(entry["root"], "root")
            checker.require(index < self.block, f"{what} has no root {index}")
            checker.require(index not in exact, f"root {first + index} is given twice")
            box = checker.Box({k: entry[k] for k in ("bits", "radius", "center")}, self.size)
            checker.require(
                box.bits <= MOST_DIGITS
                and all(len(text) <= MOST_DIGITS for text in (entry["radius"], *entry["center"])),
                f"root {first + index} is out of range",
            )
            root = Root(box.center, box.radius, box.bits)
            exact[index] = (root, checker.text_of(entry["assignment"]))
        centers, radii, folds = parts
        return Block(first, bits, width, centers, radii, folds, exact)

    def check_block(self, block: Block, done: Sequence[bool] | None = None) -> None:
        """Verify every root of a block but those marked as done; raises `CertificateError`."""
        for index in range(self.block):
            given = index in block.exact
            what = f"root {block.first + index}"
            checker.require(
                given == (block.radii[index] == UNPROVED), f"{what} is given twice or not at all"
            )
            if given:
                root, letters = block.exact[index]
                self.check_root(root, block.first + index, letters)
            elif done is None or not done[index]:
                checker.require(block.radii[index] <= MOST_BITS, f"{what}: no such radius")
                center = block.center(index, self.size)
                root = Root(center, 1 << block.radii[index], block.bits)
                self.check_root(root, block.first + index, self.letters(block, index))

    def letters(self, block: Block, index: int) -> str:
        """The assignment of a root: M where the bit of a fold is not set, V where it is."""
        start = index * self.letter_bytes
        bits = int.from_bytes(block.folds[start : start + self.letter_bytes], "little")
        checker.require(not bits >> len(self.fold_rows), "a bit of no fold is set")
        return "".join("MV"[bits >> k & 1] for k in range(len(self.fold_rows)))

    def check_root(self, root: Root, number: int, letters: str) -> None:
        """One regular zero in the box, with the signs of its number and the folds given."""
        self.krawczyk.check(root.center, root.radius, root.bits)
        for k, row in enumerate(self.vertex_rows):
            checker.require(
                root.sign(row) == (-1 if number >> k & 1 else 1),
                f"root {number}: vertex {self.emptied.interior[k]} has not the sign of its number",
            )
        signs = {
            f: root.sign(row) for f, row in zip(self.emptied.folds, self.fold_rows, strict=True)
        }
        if None in signs.values():
            checker.close_flat(self.emptied, signs)
        found = "".join("MFVU"[1 + checker.digit(signs[f])] for f in self.emptied.folds)
        checker.require(
            checker.agrees(letters, found), f"root {number}: folds are {found}, not {letters}"
        )


# --- the file ------------------------------------------------------------------------------------

_chambers: Chambers | None = None  # of a worker process


def start_worker(header: str) -> None:
    """Rebuild the sheet in a worker process."""
    global _chambers
    _chambers = Chambers(read_header(header))


def check_line(text: str, number: int) -> str | None:
    """Verify one block in a worker process: None, or why it does not hold."""
    if _chambers is None:
        raise RuntimeError("the worker was not started")
    try:
        _chambers.check_block(_chambers.decode(text, number))
    except checker.CertificateError as error:
        return str(error)
    except MALFORMED as error:
        return f"malformed: {type(error).__name__} in block {number}"
    return None


def check(
    path: str,
    workers: int = 1,
    start: Any = start_worker,
    work: Any = check_line,
    least: int = 1,
) -> dict[str, Any]:
    """Verify every claim of a file; returns the claims.

    Raises `checker.CertificateError` if one is not supported, `checker.FormatError` if the file is
    no compact certificate, `OSError`. With several workers, blocks are checked in that many
    processes, at most two blocks waiting for each, unless there are fewer than `least` for each.
    `start` and `work` may be replaced by functions that do the same.
    """
    with ExitStack() as stack:
        found = lines(stack.enter_context(open(path, "rb")))
        first = next(found, None)
        if first is None:
            raise checker.FormatError("the file is empty")
        header = read_header(first)
        try:
            chambers = Chambers(header)
        except MALFORMED as error:
            raise checker.CertificateError(f"malformed: {type(error).__name__}") from error
        pool = None
        if workers > 1 and chambers.blocks >= least * workers:
            context = get_context("spawn")
            pool = ProcessPoolExecutor(workers, context, start, (first,))
            stack.callback(pool.shutdown, cancel_futures=True)
        else:
            start(first)
        waiting: deque[Future[str | None]] = deque()

        def settle(most: int) -> None:
            while len(waiting) > most:
                _raise(waiting.popleft().result())

        for number in range(chambers.blocks):
            try:
                text = next(found, None)
            except checker.FormatError:
                settle(0)  # a block before it that does not hold comes first
                raise
            if text is None:
                settle(0)
                raise checker.CertificateError(
                    f"only {number} of {chambers.blocks} blocks are there"
                )
            if pool is None:
                _raise(work(text, number))
                continue
            waiting.append(pool.submit(work, text, number))
            settle(2 * workers)
        settle(0)
        last = next(found, None)
        checker.require(last is not None, "the claims are missing")
        claims = read_object(last or "", "the last line")
        checker.keys(claims, "claims", "the last line")
        checker.require(next(found, None) is None, "something follows the claims")
        facts = chambers.claims()
        checker.keys(claims["claims"], " ".join(facts), "claims")
        for key, fact in facts.items():
            claim = claims["claims"][key]
            checker.require(
                type(claim) is type(fact) and claim == fact, f"{key} = {claim!a} is {fact!a}"
            )
        return facts


def _raise(reason: str | None) -> None:
    if reason is not None:
        raise checker.CertificateError(reason)


def main(arguments: list[str]) -> int:
    """Check one file and print the verdict; the exit code."""
    workers = arguments[1] if len(arguments) == 2 else "1"
    usable = workers.isascii() and workers.isdecimal() and len(workers) < 5
    if len(arguments) not in (1, 2) or not usable:
        print("usage: python compact_checker.py CERTIFICATE [WORKERS]", file=sys.stderr)
        return 2
    try:
        claims = check(arguments[0], int(workers))
    except checker.CertificateError as error:
        print(f"INVALID: {checker.plain(error)}")
        return 1
    except (checker.FormatError, OSError) as error:
        print(f"not a compact certificate: {checker.plain(error)}", file=sys.stderr)
        return 3
    except (BrokenExecutor, MemoryError):
        message = "a worker process died, or memory is short: nothing is known of the file"
        print(message, file=sys.stderr)
        return 70
    except Exception:  # never to be read as one of the other codes
        traceback.print_exc()
        return 70
    print(checker.summary(claims))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
