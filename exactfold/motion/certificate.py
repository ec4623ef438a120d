"""Certificates of motions, for `exactfold.checker`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from exactfold.certificates.entries import Document, emptied_evidence, pattern_document
from exactfold.checker.motion.certificate import MOTION
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern


def motion_certificate(
    pattern: CreasePattern,
    signs: Mapping[int, int],
    side: int,
    length: Fraction,
    pinned: Sequence[int],
    bits: int,
    start: Document,
    tubes: Sequence[Document],
    ends_at_a_node: bool = False,
    rim: Mapping[int, Fraction] | None = None,
    drive: tuple[Sequence[tuple[int, int]], Sequence[Fraction], bool] | None = None,
    returning: tuple[Document, Document] | None = None,
) -> Document:
    """The proof of a motion as a JSON object (docs/motion.md, The certificate).

    `signs`: those of the foldable vertices on the half-branch, by vertex of the pattern; `pinned`
    and the vertex `held` of `start` are vertices of the pattern, too. `Track.certificate` calls it.
    Of `tubes` those with the key `flat` are arcs through nodes, at which these vertices are flat.
    With `ends_at_a_node` the motion ends at the node of the last one. The certificate does not
    claim that nothing touches up to there. `rim`: with more than four corners the heights of the
    border, in the ratio of which it stays. `drive`: instead, driven folds, their squares, and
    whether the folds are beyond their angles at the end. `returning`: the half-branch along which
    the motion comes back to the flat state, and the landing there.
    """
    *steps, last = tubes if ends_at_a_node else [*tubes, {}]
    through = [step["flat"] for step in steps if "flat" in step]
    document: Document = {
        "format": MOTION.format,
        "version": MOTION.version,
        "pattern": pattern_document(pattern),
        "claims": {
            "vertex_signs": [signs.get(v, 0) for v in pattern.interior],
            "side": side,
            "length": format_rational(length),
        },
        "evidence": {
            "emptied": emptied_evidence(pattern),
            "pinned": list(pinned),
            "bits": bits,
            "start": start,
            "tubes": steps,
        },
    }
    if rim is not None:
        document["claims"]["rim"] = [format_rational(h) for _, h in sorted(rim.items())]
    if returning is not None:
        document["claims"]["return"], document["evidence"]["landing"] = returning
    if drive is not None:
        folds, squares, reached = drive
        document["claims"]["drive"] = {
            "folds": [list(fold) for fold in folds],
            "squares": [format_rational(q) for q in squares],
            "reached": reached,
        }
    if through:
        document["claims"]["through"] = through
    if ends_at_a_node:
        document["claims"]["node"] = {"flat": last["flat"], "clear": False}
        document["evidence"]["node"] = {
            key: x for key, x in last.items() if key not in ("flat", "exit")
        }
    return document
