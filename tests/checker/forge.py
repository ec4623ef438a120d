"""Forgeries: certificates that verify, changed so that one line of the checker alone stops them.

`refused` demands the exact message of that line. `stopped_by` also shows that nothing else stops
the forgery: with that line taken out its claims, made to match, are accepted. So whoever weakens
the line makes the test fail.
"""

from __future__ import annotations

import ast
import base64
import contextlib
import io
import json
import re
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from exactfold import checker
from exactfold.checker.branches import compact, listing
from exactfold.checker.core.lines import digest, lines
from exactfold.checker.core.reading import (
    CertificateError,
    FormatError,
    LimitError,
    at_most,
    require,
)
from exactfold.checker.sheets.boxes import Box
from exactfold.checker.sheets.sheet import read_sheet

Document = dict[str, Any]
Lines = list[Document]

RULES = sorted(
    ".".join(path.relative_to(Path(checker.__file__).parent).with_suffix("").parts)
    for path in Path(checker.__file__).parent.rglob("*.py")
    if re.search(r"\b(require|at_most)\(", path.read_text(encoding="utf-8"))
)
"""The modules of the checker that refuse."""

FIXTURES = Path(__file__).parent.parent / "fixtures" / "certificates"


@cache
def _text(name: str) -> str:
    return (FIXTURES / name).read_text()


def given(name: str) -> Document:
    """A fresh copy of a listing or of a certificate of one branch."""
    document: Document = json.loads(_text(f"{name}.json"))
    return document


def verified(document: Any) -> Document:
    """The claims of a JSON object, read as from a file."""
    return checker.check(checker.load(json.dumps(document)))


def with_one_key_more(document: Document, place: tuple[str | int, ...]) -> Document:
    """The document, once the object at a place has a key that it should not have."""
    value: Any = document
    for key in place:
        value = value[key]
    value["more"] = 1
    return document


def refused(document: Any, message: str) -> None:
    """The checker refuses the claims, or does not check them, with exactly this message."""
    with pytest.raises(refusal(message)) as caught:
        verified(document)
    assert str(caught.value) == message


def refusal(message: str) -> type[Exception]:
    """The error with this message: files beyond a limit are not checked."""
    return LimitError if message.startswith("not checked: ") else CertificateError


def beyond(what: str, found: int, most: int, limit: str) -> str:
    """The message for a file that asks for more than a limit."""
    said = f"{what}, {found}, are more than the limit, {most}"
    return f"not checked: {said} ({limit} in checker/core/limits.py)"


def unreadable(text: str, message: str) -> None:
    """The checker does not take the text for a certificate, with exactly this message."""
    with pytest.raises(FormatError) as caught:
        checker.load(text)
    assert str(caught.value) == message


def stopped_by(document: Document, message: str) -> Document:
    """With claims to match its evidence, refused with this message, and without that line accepted.

    Returns the false certificate.
    """
    with without(message):
        forged = completed(document)
    refused(forged, message)
    return forged


@contextlib.contextmanager
def without(message: str) -> Iterator[None]:
    """The checker with the `require`, or the limit, of one message taken out."""

    def weaker(condition: object, said: str) -> None:
        require(condition or said == message, said)

    def higher(found: int, most: int, what: str, limit: str) -> None:
        try:
            at_most(found, most, what, limit)
        except LimitError:
            if not (message.startswith(f"not checked: {what}, ") and f" ({limit} in " in message):
                raise

    with pytest.MonkeyPatch.context() as patch:
        for name in RULES:
            module = import_module(f"exactfold.checker.{name}")
            for line, other in (("require", weaker), ("at_most", higher)):
                if hasattr(module, line):
                    patch.setattr(module, line, other)
        yield


_BRANCH = re.compile(r"branch (\d+): (its|either) [a-z ]*shows (\S*) (\S*?)(?: or .*)?, not")
_MULTIPLICITY = re.compile(r"branch (\d+): multiplicity is (\d+)")
_CLAIM = re.compile(r"claim (\w+) = .*, but it is (.*)")


def stopped(document: Document, message: str) -> None:
    """Refused with this message, and accepted without that line."""
    with without(message):
        verified(document)
    refused(document, message)


def completed(document: Document) -> Document:
    """The certificate with the claims that its evidence seems to show."""
    made: Document = json.loads(json.dumps(document))
    claims, said = made["claims"], []
    roots = made["evidence"].get("roots")
    if roots is not None:
        fresh = {
            "vertex_signs": "",
            "assignment": "",
            "multiplicity": 1,
            "representative": "saddle",
        }
        claims["branches"] = [dict(fresh) for _ in roots]
    other = listing.require

    def told(condition: object, message: str) -> None:
        if not condition and any(form.match(message) for form in (_BRANCH, _MULTIPLICITY, _CLAIM)):
            said.append(message)
        else:
            other(condition, message)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(listing, "require", told)
        verified(made)
    for text in said:
        if found := _BRANCH.match(text):
            number, side, signs, letters = found.groups()
            claims["branches"][int(number)] |= {
                "vertex_signs": signs,
                "assignment": letters,
                "representative": "saddle" if side == "its" else "either",
            }
        elif found := _MULTIPLICITY.match(text):
            claims["branches"][int(found[1])]["multiplicity"] = int(found[2])
        elif found := _CLAIM.match(text):
            claims[found[1]] = ast.literal_eval(found[2])
    verified(made)
    return made


def sealed(document: Document) -> Document:
    """The certificate with the digest of its own pattern."""
    document["claims"]["sha256"] = read_sheet(document["pattern"])[1]
    return document


def drop_roots(document: Document, chosen: Callable[[Document], bool], count: int) -> None:
    """Take out the first `count` of the roots that are chosen, with their branches."""
    roots, branches = document["evidence"]["roots"], document["claims"]["branches"]
    places = [k for k, root in enumerate(roots) if chosen(root)][:count]
    assert len(places) == count
    for k in reversed(places):
        del roots[k], branches[k]


def cross() -> Document:
    """The cross as the class 2 t^2 - t, x = t, of its zeros 0 and 1/2."""
    made = given("listing-cross")
    made["evidence"] = {
        "kind": "algebraic",
        "triangles": [],
        "chart": None,
        "multipliers": ["1"],
        "separating": [1],
        "classes": [{"polynomial": ["0", "-1", "2"], "numerators": [["0", "1"]], "flat": []}],
        "roots": [{"class": 0, "interval": [x, x]} for x in ("0", "1/2")],
    }
    return made


def in_box(root: Document) -> bool:
    """Whether a root is listed as a box in the unknowns of the system."""
    return "bits" in root and "flat" not in root


def product(p: list[Fraction], q: list[Fraction]) -> list[Fraction]:
    """The product of two polynomials."""
    result = [Fraction(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            result[i + j] += a * b
    return result


def shifted(p: list[Fraction], by: int) -> list[Fraction]:
    """p(t - by)."""
    result, power = [Fraction(0)] * len(p), [Fraction(1)]
    for c in p:
        for k, x in enumerate(power):
            result[k] += c * x
        power = product(power, [Fraction(-by), Fraction(1)])
    return result


# --- compact certificates ------------------------------------------------------------------------


def given_lines(name: str) -> Lines:
    """A fresh copy of the lines of a compact certificate."""
    return [json.loads(line.partition("\t")[0]) for line in _text(f"{name}.txt").splitlines()]


def chained(parts: Lines) -> bytes:
    """A compact certificate with right digests, whatever its lines say."""
    last, data = "", ""
    for part in parts:
        text = json.dumps(part, separators=(",", ":"))
        last = digest(last, text)
        data += f"{text}\t{last}\n"
    return data.encode()


def verified_lines(data: Lines | bytes) -> Document:
    """The claims of a compact certificate."""
    content = data if isinstance(data, bytes) else chained(data)
    return compact.check_lines(lines(io.BytesIO(content)))


def refused_lines(
    data: Lines | bytes, message: str, error: type[Exception] = CertificateError
) -> None:
    """The checker refuses a compact certificate, with exactly this message."""
    with pytest.raises(error) as caught:
        verified_lines(data)
    assert str(caught.value) == message


def raw(line: Document, key: str) -> bytearray:
    """The bytes of one entry of a block."""
    return bytearray(base64.b64decode(line[key]))


def put(line: Document, key: str, data: bytes | bytearray) -> None:
    """Set the bytes of one entry of a block."""
    line[key] = base64.b64encode(data).decode()


# --- boxes ---------------------------------------------------------------------------------------


def entry_of(box: Box) -> Document:
    """A box as a certificate holds it."""
    return {"bits": box.bits, "radius": str(box.radius), "center": [str(m) for m in box.center]}
