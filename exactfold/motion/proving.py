"""`prove`: the proof of a motion that was followed in floats."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from exactfold.errors import NotProvedAtTheFlatStateError
from exactfold.evidence.entries import Document
from exactfold.motion.arclength import Interval, in_floats
from exactfold.motion.contact_claims import certificate_with_contact
from exactfold.motion.contacts import ContactWatch, FirstContact
from exactfold.motion.events import CONTACT, FLAT_FOLD, RETURN
from exactfold.motion.loop_proofs import Loop
from exactfold.motion.loops import LoopFinder
from exactfold.motion.motion import Motion
from exactfold.motion.tracks import Link, Track, follow_proved, half_branch
from exactfold.problem.problem import Problem
from exactfold.progress import Progress
from exactfold.verdict import PROVED, UNDECIDED, Verdict


@dataclass(frozen=True, repr=False)
class MotionProof:
    """What is proved of a motion: that it exists, without a gap, and what touches first.

    `track`: the chain of tubes, None for a motion until its return. `contact`: how far no two faces
    touch, and the first contact if the motion meets one; None until the return. `passed`: the
    motion goes on after that contact, through the paper. `loop`: of a motion until its return.
    `length` bounds how far it is proved, in the unit of the sheet.

    `status` is PROVED if all of the motion is, and its contact where it ends at one; else `reason`
    says what is missing.
    """

    status: Verdict
    reason: str
    length: Interval
    tubes: int
    track: Track | None = None
    contact: FirstContact | None = None
    passed: bool = False
    loop: Loop | None = None

    def certificate(self) -> Document | None:
        """The evidence for `exactfold.checker`; None for a motion until its return.

        The certificate of a loop is one of `exactfold motions`. Of a contact that the motion
        passes nothing is claimed.
        """
        if self.track is None:
            return None
        if self.contact is None or self.passed:
            return self.track.certificate()
        return certificate_with_contact(self.track, self.contact)

    def to_dict(self) -> dict[str, Any]:
        """The proof as `exactfold fold --json` prints it."""
        contact = self.contact
        event = None if contact is None else contact.event
        return {
            "status": str(self.status),
            "reason": self.reason,
            "tubes": self.tubes,
            "length": list(in_floats(self.length)),
            "clear": None if contact is None else in_floats((contact.clear, contact.clear))[0],
            "contact": None if event is None else event.to_dict(),
            "to": None
            if self.loop is None or self.loop.target is None
            else self.loop.target.to_dict(),
        }

    def __repr__(self) -> str:
        return f"<MotionProof: {self.status}, {self.tubes} tubes>"


def prove(motion: Motion, *, progress: Progress | None = None) -> MotionProof:
    """Prove a motion as far as it was followed.

    Tubes hold one configuration for each parameter, from the flat state to the end of the motion
    (docs/motion.md), and separating planes show what does not touch (docs/contacts.md). A motion
    until its first contact is proved with that contact; any other one with how far it is clear.
    Nodes are passed where the motion returns to the flat state (docs/motions.md), and are its end
    otherwise.

    Raises `UsageError` where the branch is not proved. UNDECIDED says nothing against the motion.

    >>> from exactfold.count.find import find_branch
    >>> from exactfold.motion.following import follow
    >>> proof = prove(follow(find_branch("two-vertex", "+-")))
    >>> proof.status, proof.contact.event.kind
    (<Verdict.PROVED: 'proved'>, 'flat-fold')
    """
    try:
        return _returning(motion) if motion.end == RETURN else _tracked(motion, progress)
    except NotProvedAtTheFlatStateError as error:
        return MotionProof(UNDECIDED, str(error), (Fraction(0), Fraction(0)), 0)


def _tracked(motion: Motion, progress: Progress | None) -> MotionProof:
    watch = ContactWatch()
    to_contact = motion.end in (CONTACT, FLAT_FOLD)
    found: FirstContact | None = None
    links: list[Link] = []

    def stop(link: Link) -> str | None:
        nonlocal found
        links.append(link)
        if progress is not None:
            progress("proving, tubes", len(links), 0)
        if found is not None:
            return None
        said = watch(link)
        if said is None:
            return None
        if to_contact:
            return said
        found = watch.result(replace(so_far, links=tuple(links)))
        return None

    until = None if to_contact else motion.duration
    so_far = half_branch(motion.branch, motion.side)
    track = follow_proved(motion.branch, motion.side, until=until, stop=stop)
    contact = watch.result(track) if found is None else found
    status, reason = track.status, "" if track.status is PROVED else track.reason
    if to_contact and status is PROVED and contact.status is not PROVED:
        status, reason = UNDECIDED, contact.reason
    passed = found is not None
    return MotionProof(status, reason, track.length, len(track.links) + 1, track, contact, passed)


def _returning(motion: Motion) -> MotionProof:
    problem = Problem.of(motion.branch.pattern)
    loop = LoopFinder(problem).follow(motion.branch, motion.side).outline
    return MotionProof(loop.status, loop.reason, loop.length, loop.tubes, loop=loop)
