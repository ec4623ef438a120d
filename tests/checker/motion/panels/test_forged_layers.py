"""Forged orders of layers in which motions of panels are claimed to end."""

from __future__ import annotations

import json
from functools import cache

import pytest
from forge import Document, beyond, refused, stopped, verified, with_one_key_more
from forge_panel_motions import strip
from sampling import slow_after

import exactfold
from exactfold import checker
from exactfold.checker.core.intervals import Interval
from exactfold.checker.core.reading import LimitError
from exactfold.checker.layers.folding import FoldedSheet
from exactfold.checker.layers.overlaps import Overlaps
from exactfold.checker.motion.panels.folding import Folding
from exactfold.checker.motion.panels.layers import Heights, Layers
from exactfold.checker.motion.panels.series import BITS
from exactfold.checker.sheets.panels import read_panels
from exactfold.layers.certificate import digits_of
from exactfold.motion import follow_panels

WAYS = [("square-twist", 1), ("square-twist", 6), ("fish-base", 2), ("pinwheel-base", 3)]


def accordion() -> object:
    """Two folds, by equal angles to different sides; the last panel comes to lie on the first."""
    sheet = strip([4, 2, 2])
    rates = {fold: (-1.0) ** k for k, fold in enumerate(sheet.folds)}
    return follow_panels(sheet, amounts=rates, until="180deg", frames=2)


@cache
def _text(name: str, way: int) -> str:
    motion = accordion() if not way else exactfold.follow(name, way, until="180deg", frames=2)
    return json.dumps(exactfold.prove(motion).certificate())


def whole(name: str = "accordion", way: int = 0) -> Document:
    document: Document = json.loads(_text(name, way))
    return document


def overlaps_of(document: Document) -> Overlaps:
    sheet, _ = read_panels(document["pattern"])
    letters = dict(zip(sheet.folds, document["claims"]["assignment"], strict=True))
    pieces = [tuple(piece) for piece in document["claims"]["layers"]["pieces"]]
    return Overlaps(FoldedSheet(sheet, letters, pieces))


def folding_of(document: Document) -> Folding:
    sheet, _ = read_panels(document["pattern"])
    return Folding(sheet, document["claims"], document["evidence"])


def bits_of(document: Document, count: int) -> list[bool]:
    order = document["claims"]["layers"]["order"]
    return [bit == "1" for digit in order for bit in f"{int(digit, 16):04b}"][:count]


@pytest.mark.parametrize(("name", "way"), slow_after(1, WAYS))
def test_the_order_has_no_crossing_and_the_letters_of_the_motion(name: str, way: int) -> None:
    """Two ways: heights to first order, and all places where layers could cross."""
    document = whole(name, way)
    claims = verified(document)
    layers, letters = claims["layers"], claims["assignment"]
    count = len(layers["pieces"])
    said = (
        f"; it ends in the flat-folded state with the given order of layers of its {count} pieces"
    )
    assert said in checker.summary(claims)
    state = {
        "format": "exactfold flat-folded states",
        "version": 1,
        "kind": "flat-state",
        "pattern": document["pattern"],
        "claims": {
            "letters": letters.replace("M", "U").replace("V", "U"),
            "assignment": letters,
            "pieces": count,
            "pairs": len(overlaps_of(document).pairs),
        },
        "evidence": layers,
    }
    assert verified(state)["assignment"] == letters


def test_any_piece_may_be_the_first() -> None:
    """If the first piece is one that is turned over, the order is reversed."""
    document = whole("fish-base", 2)
    overlaps = overlaps_of(document)
    folding = folding_of(document)
    up, pieces = overlaps.folded.up, document["claims"]["layers"]["pieces"]
    lower = dict(zip(overlaps.pairs, bits_of(document, len(overlaps.pairs)), strict=True))
    assert {True, False} == set(up)
    for first in range(len(pieces)):
        order = [first, *(k for k in range(len(pieces)) if k != first)]
        document["claims"]["layers"]["pieces"] = [pieces[k] for k in order]
        pairs = [(order[i], order[j]) for i, j in overlaps_of(document).pairs]
        bits = [lower[i, j] if i < j else not lower[j, i] for i, j in pairs]
        right, reverse = digits_of(bits), digits_of([not bit for bit in bits])
        for bits_here, fits in ((right, up[first]), (reverse, not up[first])):
            document["claims"]["layers"]["order"] = bits_here
            claim = Layers(document["claims"], document["evidence"])
            if fits:
                claim.check(folding)
            else:
                with pytest.raises(checker.CertificateError, match="is not proved to end"):
                    claim.check(folding)


@pytest.mark.slow
def test_pieces_in_another_order() -> None:
    """Each pair alone is stopped, in a stack and where pieces share folds and corners."""
    for document in (whole("fish-base", 2), whole()):
        pairs, folding = overlaps_of(document).pairs, folding_of(document)
        bits = bits_of(document, len(pairs))
        for k, (i, j) in enumerate(pairs):
            word = "above" if bits[k] else "below"
            other = [bit != (m == k) for m, bit in enumerate(bits)]
            document["claims"]["layers"]["order"] = digits_of(other)
            message = f"piece {i} is not proved to end {word} piece {j}"
            with pytest.raises(checker.CertificateError, match=f"^{message}$"):
                Layers(document["claims"], document["evidence"]).check(folding)
        stopped(document, message)


def test_pieces_at_one_height() -> None:
    """Nothing is known of the order of pieces with the same height to first order."""
    document = whole("fish-base", 2)
    overlaps = overlaps_of(document)
    heights = Heights(folding_of(document), overlaps)
    assert {heights.sign(*pair) for pair in overlaps.pairs} <= {1, -1}
    heights.places = [[x, y, Interval(0, 0, BITS)] for x, y, _ in heights.places]
    assert {heights.sign(*pair) for pair in overlaps.pairs} == {0}


def test_keys_and_bits() -> None:
    document = whole()
    with_one_key_more(document, ("claims", "layers"))
    refused(document, "layers: expected an object with the keys pieces order")
    document = whole()
    document["claims"]["layers"]["order"] += "0"
    refused(document, "the order does not have 3 bits in hexadecimal digits")


def test_only_motions_that_close_end_in_layers() -> None:
    for version, without in ((1, "closed"), (3, None), (4, "closed")):
        document = whole()
        document["version"] = version
        document["claims"].pop(without, None)
        with pytest.raises(checker.CertificateError, match="expected an object with the keys"):
            verified(document)


def test_the_work_is_limited() -> None:
    document = whole()
    folding = folding_of(document)
    layers = Layers(document["claims"], document["evidence"])
    layers.check(folding)
    tests = folding.panels.spent
    assert tests == 3 * 4 * 4
    folding = folding_of(document)
    folding.panels.work = tests - 1
    with pytest.raises(LimitError) as caught:
        layers.check(folding)
    assert str(caught.value) == beyond("the tests of contacts", tests, tests - 1, "MOST_TESTS")
