"""`prove_persistently`: a proof repeated with more bits, and with another face held."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.motion import Motion
from exactfold.motion.proving import BITS, MotionProof, prove
from exactfold.pattern.crease_pattern import Triangle


def prove_persistently(
    motion: Motion,
    again: Callable[[Triangle], Motion],
    *,
    progress: Progress | None = None,
) -> MotionProof:
    """`prove`, and where tubes fail once more with more bits, then with another triangle held.

    `again` follows the same motion with a triangle of the framework held: times are others then,
    and so is `MotionProof.motion`. Where floats found a node or a singular configuration at the
    end nothing more is tried. What was tried is in `MotionProof.reason`. Raises as `prove`.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.motion.following import follow
    >>> branch = find_branch("two-vertex", "+-")
    >>> motion = follow(branch, until="30deg", frames=2)
    >>> prove_persistently(motion, lambda held: follow(branch, until="30deg", pinned=held)).status
    <Verdict.PROVED: 'proved'>
    """
    found = prove(motion, progress=progress)
    if not found.may_succeed_otherwise:
        return found
    other = _another(motion.curve.framework)
    held = [motion.pinned]
    finer = prove(motion, bits=BITS[1], progress=progress)
    if finer.may_succeed_otherwise and other is not None:
        turned = again(other)
        held.append(turned.pinned)
        by_turning = prove(turned, bits=BITS[1], progress=progress)
        if by_turning.status is PROVED:
            return by_turning
    if not finer.may_succeed_otherwise:
        return finer
    faces = " and ".join("-".join(map(str, face)) for face in held)
    tried = f"tried: steps down to 1e-7, {BITS[0]} and {BITS[1]} bits, face {faces} held"
    best = max(found, finer, key=lambda proof: proof.length[0])
    return replace(best, reason=f"{best.reason} ({tried})")


def _another(framework: Framework) -> Triangle | None:
    """The triangle to hold instead: one with as few of the same corners as possible.

    None where there is no other, and with a rim: the rim path with another one held is another.
    """
    if framework.ties:
        return None
    held = set(framework.pinned)
    others = [t for t in framework.sheet.triangles if set(t) != held]
    return min(others, key=lambda t: len(held & set(t)), default=None)
