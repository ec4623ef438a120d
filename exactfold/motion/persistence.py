"""`prove_persistently`: a proof that is repeated with more bits and with another face held."""

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
    """Call `prove`; where tubes fail, try more bits, then hold another triangle.

    `again` follows the same motion while a given triangle of the framework is held; its times are
    different then, and so is `MotionProof.motion`. If floats found a branch point or a singular
    configuration at the end, nothing more is tried. `MotionProof.reason` says what was tried.
    Raises the errors of `prove`.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.motion.following import follow
    >>> branch = find_branch("two-vertex", "+-")
    >>> motion = follow(branch, until="30deg", frames=2)
    >>> prove_persistently(motion, lambda held: follow(branch, until="30deg", pinned=held)).status
    <Verdict.PROVED: 'proved'>
    """
    first_proof = prove(motion, progress=progress)
    if not first_proof.may_succeed_otherwise:
        return first_proof
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
    best = max(first_proof, finer, key=lambda proof: proof.length[0])
    return replace(best, reason=f"{best.reason} ({tried})")


def _another(framework: Framework) -> Triangle | None:
    """The triangle to hold instead: one with as few corners in common as possible.

    None if there is no other triangle. Also None with boundary heights, because then another held
    triangle changes the motion.
    """
    if framework.ties:
        return None
    held = set(framework.pinned)
    others = [t for t in framework.sheet.triangles if set(t) != held]
    return min(others, key=lambda t: len(held & set(t)), default=None)
