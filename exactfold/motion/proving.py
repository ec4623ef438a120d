"""`prove`: the proof of a motion that was followed in floats."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.certificates.entries import CertificateLines, Document, write_certificate
from exactfold.errors import NotApplicableError, NotProvedAtTheFlatStateError
from exactfold.motion.contacts.claims import certificate_with_contact
from exactfold.motion.contacts.contacts import ContactWatch, FirstContact
from exactfold.motion.curves.boundary_path import problem_of
from exactfold.motion.curves.events import CONTACT, DRIVEN, FLAT_FOLD, NODE, RETURN, SINGULAR, Event
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.motion import Motion
from exactfold.motion.curves.motion_document import LastBranchPoint, ProofDocument
from exactfold.motion.enclosed import with_enclosed_frames
from exactfold.motion.loops.frames import frame_of
from exactfold.motion.loops.loops import LoopFinder
from exactfold.motion.loops.proofs import Loop, LoopProof
from exactfold.motion.tubes.arclength import Interval, in_floats
from exactfold.motion.tubes.chain import Step
from exactfold.motion.tubes.passages import Passage
from exactfold.motion.tubes.tracks import Frame, Track, follow_proved, ray

BITS = 64, 128
"""After the point, of the numbers in tubes: what is tried, one after the other."""

_AT_ONCE = 1e-9
_FARTHER = Fraction(1, 1000)
"""Of its time: what goes on so much longer than to the node that floats see meets none."""
_BEYOND = 1e-8
"""Of its time: so much longer a motion is followed, so that driven folds are beyond their goals."""
_NAMED = 3
_NO_NODE = "no node was met where floats see one"
_STRAYED = "the frames in floats are not near the proved curve: floats have left the branch"


@dataclass(frozen=True, repr=False)
class MotionProof:
    """What is proved of a motion: that it exists, without a gap, and what touches first.

    `motion`: the motion with the frames of the proved curve, each with a bound of how far it is off
    (`Motion.bounds`); as it was given where it is not proved to its end. `track`: the chain of
    tubes, None for a motion until its return. `contact`: how far no two faces touch, and the first
    contact if the motion meets one; None until the return. `passed`: the motion goes on after that
    contact, through the paper, or after it is not known to be clear. `branch_point`: where the
    proof ends at a node (`Track.branch_point`). `looped`: the proof of a motion until its return.
    `length` bounds how far it is proved, in the unit of the sheet.

    `status` is PROVED if all of the motion is, and its contact where it ends at one; of a motion
    that ends at a node also that no two faces touch up to the node, unless the motion goes through
    the paper before. Else `reason` says what is missing.
    """

    status: Verdict
    reason: str
    motion: Motion
    length: Interval
    tubes: int
    track: Track | None = None
    contact: FirstContact | None = None
    passed: bool = False
    looped: LoopProof | None = None

    @property
    def loop(self) -> Loop | None:
        """Of a motion until its return, where it ends."""
        return None if self.looped is None else self.looped.outline

    @property
    def branch_point(self) -> Passage | None:
        """The way to the node at which the proof ends, None if it ends elsewhere."""
        return None if self.track is None else self.track.branch_point

    @property
    def through(self) -> tuple[Passage, ...]:
        """The passages of the nodes that the motion goes through."""
        if self.looped is not None:
            return tuple(step for step in self.looped.steps if isinstance(step, Passage))
        return () if self.track is None else self.track.through

    @property
    def clear_to_the_end(self) -> bool:
        """Whether no two faces touch on all that is proved, nor in its last configuration."""
        return self.contact is not None and not self.passed and self.contact.clear_to_the_end

    @property
    def back_text(self) -> str:
        """Along which half-branch the motion comes back, in words; empty if it does not."""
        loop = self.loop
        if loop is None or loop.target is None:
            return ""
        if self.motion.boundary_heights is None:
            return str(loop.target)
        way = "as given" if loop.target.saddle > 0 else "the other way up"
        return f"{loop.target.sign_text}, with the border {way}"

    @property
    def reached(self) -> bool | None:
        """Whether driven angles are proved to reach the sizes in the drive; None without a drive.

        At the end they are that large or larger, all to the right side (docs/motion.md, 10).
        Of the one fold that is driven on a sheet with four corners nothing is said.
        """
        return None if self.track is None or self.track.drive is None else self.track.reached

    @property
    def through_text(self) -> str:
        """Which nodes the motion goes through, in words; empty if it meets none."""
        nodes = [
            f"a node at the time {in_floats(self._time_of(branch_point))[1]:.6g}, "
            f"where {branch_point.what}"
            for branch_point in self.through
        ]
        return f"through {' and '.join(nodes)}" if nodes else ""

    @property
    def end_text(self) -> str:
        """Where the node is at which the proof ends, in words; empty if it ends elsewhere."""
        if self.branch_point is None:
            return ""
        time = in_floats(self.length)[1]
        return f"until a node at the time {time:.6g}, where {self.branch_point.what}"

    @property
    def may_succeed_otherwise(self) -> bool:
        """Whether tubes failed at a place where floats see nothing singular."""
        if self.status is PROVED or self.motion.end == SINGULAR:
            return False
        return self.reason != _STRAYED and (self.track is None or self.track.status is not PROVED)

    def certificate(self) -> Document | CertificateLines:
        """The certificate of what is proved, for `exactfold.check` and `write_certificate`.

        With four corners a motion until its return is one loop in a file of loops
        (docs/motions.md), if it is proved to its end. Any other motion has a certificate of its
        own, as far as it is proved. Nothing is claimed of a contact that the motion passes.

        Raises `NotApplicableError` where nothing is proved that a certificate could state.

        >>> import exactfold
        >>> proof = exactfold.prove(exactfold.follow("two-vertex", signs="+-", until="return"))
        >>> exactfold.check(proof.certificate()).text[:57]
        'VALID: 1 loop of true motions, which match 4 of 8 half-br'
        """
        looped, boundary_heights = self.looped, self.motion.boundary_heights
        if looped is not None and looped.landing is not None:
            return (
                looped.lines() if boundary_heights is None else looped.certificate(boundary_heights)
            )
        if self.track is None:
            raise NotApplicableError(f"there is no certificate: {self.reason}")
        if self.contact is None or self.passed:
            return self.track.certificate()
        return certificate_with_contact(self.track, self.contact)

    def write(self, path: str | os.PathLike[str]) -> bool:
        """Write `certificate`; False if there is none. Raises `UnwritableFileError`.

        >>> import os, tempfile
        >>> from exactfold.checker import summary, verify
        >>> from exactfold.branches.counting.find import find_branch
        >>> from exactfold.motion.following import follow
        >>> proof = prove(follow(find_branch("two-vertex", "+-"), until="return"))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "proof")
        ...     proof.write(path), summary(verify(path))[:57]
        (True, 'VALID: 1 loop of true motions, which match 4 of 8 half-br')
        """
        try:
            write_certificate(self.certificate(), path)
        except NotApplicableError:
            return False
        return True

    def to_dict(self) -> ProofDocument:
        """The proof as `exactfold fold --json` prints it."""
        contact, loop = self.contact, self.loop
        event = None if contact is None else contact.event
        return {
            "status": str(self.status),
            "reason": self.reason,
            "tubes": self.tubes,
            "length": list(in_floats(self.length)),
            "clear": None if contact is None else in_floats((contact.clear, contact.clear))[0],
            "contact": None if event is None else event.to_dict(),
            "through": [
                {
                    "flat": list(branch_point.vertices),
                    "time": list(in_floats(self._time_of(branch_point))),
                }
                for branch_point in self.through
            ],
            "node": None
            if self.branch_point is None
            else self._branch_point_dict(self.branch_point),
            "reached": self.reached,
            "to": None if loop is None or loop.target is None else loop.target.to_dict(),
        }

    def _time_of(self, branch_point: Passage) -> Interval:
        """Bounds of the time at a node, in the unit of the sheet."""
        low, high = branch_point.time(0)
        unit = branch_point.tube.framework.unit
        return low * unit, high * unit

    def _branch_point_dict(self, branch_point: Passage) -> LastBranchPoint:
        return {
            "flat": list(branch_point.vertices),
            "time": list(in_floats(self.length)),
            "clear": self.clear_to_the_end,
        }

    def __repr__(self) -> str:
        return f"<MotionProof: {self.status}, {self.tubes} tubes>"


def prove(motion: Motion, *, bits: int = BITS[0], progress: Progress | None = None) -> MotionProof:
    """Prove a motion as far as it was followed.

    Tubes hold one configuration for each parameter, from the flat state to the end of the motion
    (docs/motion.md), and separating planes show what does not touch (docs/contacts.md). A motion
    until its first contact is proved with that contact; any other one with how far it is clear.
    Through nodes that the motion passes the proof goes on along the same arc (docs/motions.md); a
    motion that ends at a node is proved up to it. The frames of the motion that is returned are
    those of the proved curve, each in a box (`Motion.bounds`). `bits`: after the point, of all
    numbers in the tubes.

    Raises `UsageError` where the branch is not proved. UNDECIDED says nothing against the motion.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.motion.following import follow
    >>> proof = prove(follow(find_branch("two-vertex", "+-")))
    >>> proof.status, proof.contact.event.kind, max(proof.motion.bounds.radii) < 1e-14
    (<Verdict.PROVED: 'proved'>, 'flat-fold', True)
    """
    try:
        if motion.end == RETURN and not motion.curve.framework.coupling.rows:
            return _returning(motion, bits, progress)
        return _tracked(motion, bits, progress)
    except NotProvedAtTheFlatStateError as error:
        return MotionProof(UNDECIDED, str(error), motion, (Fraction(0), Fraction(0)), 0)


def _tracked(motion: Motion, bits: int, progress: Progress | None) -> MotionProof:
    watch = ContactWatch()
    to_contact = _ends_at_the_first_contact(motion)
    to_branch_point = motion.end == NODE
    missed = Fraction(motion.duration) * (1 + _FARTHER)
    found: FirstContact | None = None
    seen = 0

    def stop(step: Step) -> str | None:
        nonlocal found, seen
        seen += 1
        if progress is not None:
            progress("proving, tubes", seen, 0)
        if to_branch_point and step.entered[0] * so_far.framework.unit > missed:
            return _NO_NODE
        if found is not None:
            return None
        said = watch(step)
        if said is None or to_contact:
            return said
        found = watch.result(so_far)
        return None

    until = None if to_contact or to_branch_point else motion.duration
    if motion.end == DRIVEN:
        until = motion.duration * (1 + _BEYOND)
    pinned = motion.curve.framework.pinned
    so_far = ray(motion.branch, motion.side, pinned, bits=bits, drive=motion.drive)
    track = follow_proved(
        motion.branch,
        motion.side,
        until=until,
        stop=stop,
        through_branch_points=_passes_branch_points(motion),
        pinned=pinned,
        bits=bits,
        drive=motion.drive,
    )
    contact = watch.result(track) if found is None else found
    status, reason = _judged(motion, track, contact)
    met = found is not None or (contact.event is not None and not to_contact)
    passed = met and contact.clear < Fraction(motion.duration)
    proof = MotionProof(status, reason, motion, track.length, track.tubes, track, contact, passed)
    if track.branch_point is not None and status is not PROVED:
        proof = replace(proof, reason=f"proved {proof.end_text}, but {reason}")
    return _with_frames(proof, track.framework, track.frame)


def _judged(motion: Motion, track: Track, contact: FirstContact) -> tuple[Verdict, str]:
    """Whether a motion is proved to its end, or what is missing."""
    to_contact, branch_point = _ends_at_the_first_contact(motion), _branch_point_of(motion)
    if motion.end == NODE and track.branch_point is not None:
        if contact.event is None and not contact.clear_to_the_end:
            return UNDECIDED, _not_apart(contact)
        return PROVED, ""
    if motion.end == NODE and track.status is PROVED:
        return UNDECIDED, track.reason
    if to_contact and contact.status is PROVED:
        return PROVED, ""
    if track.branch_point is not None and (to_contact or track.status is not PROVED):
        return UNDECIDED, "floats went on without seeing this node"
    if track.status is PROVED:
        proved = contact.status is PROVED or not to_contact
        return (PROVED, "") if proved else (UNDECIDED, contact.reason)
    if branch_point is None or track.through:
        return UNDECIDED, track.reason
    unproved = f"floats see a node at the time {branch_point.time[1]:.6g}, which is not proved"
    return UNDECIDED, f"{track.reason}; {unproved}"


def _not_apart(contact: FirstContact) -> str:
    """Which faces are not proved to stay apart."""
    names = [" and ".join("-".join(map(str, face)) for face in pair) for pair in contact.open_faces]
    more = f", and {len(names) - _NAMED} more pairs" if len(names) > _NAMED else ""
    return f"faces {', '.join(names[:_NAMED])}{more} are not proved to stay apart"


def _branch_point_of(motion: Motion) -> Event | None:
    """The first node on a motion, as floats see it."""
    return next((event for event in motion.events if event.kind == NODE), None)


def _passes_branch_points(motion: Motion) -> bool:
    """Whether a motion goes on beyond a node, as floats see it."""
    return motion.end != NODE and _branch_point_of(motion) is not None


def _ends_at_the_first_contact(motion: Motion) -> bool:
    """Whether nothing touches before the end of a motion, and something does there."""
    touching = [event for event in motion.events if event.kind in (CONTACT, FLAT_FOLD)]
    return motion.end in (CONTACT, FLAT_FOLD) and all(
        event.time[1] >= motion.duration * (1 - _AT_ONCE) for event in touching
    )


def _returning(motion: Motion, bits: int, progress: Progress | None) -> MotionProof:
    looped = LoopFinder(problem_of(motion.branch)).follow(
        motion.branch,
        motion.side,
        pinned=motion.curve.framework.pinned,
        bits=bits,
        progress=progress,
    )
    loop = looped.outline
    proof = MotionProof(loop.status, loop.reason, motion, loop.length, loop.tubes, looped=looped)
    return _with_frames(proof, looped.start.framework, partial(frame_of, looped))


def _with_frames(
    proof: MotionProof, framework: Framework, frame: Callable[[float], Frame]
) -> MotionProof:
    """The proof with enclosed frames; UNDECIDED if it is that of another motion."""
    if proof.status is not PROVED:
        return proof
    longest = in_floats((proof.length[1], proof.length[1]))[0]
    times = [min(time, longest) for time in proof.motion.times.tolist()]
    if proof.branch_point is not None and proof.motion.end == NODE:
        times[-1] = longest  # the node itself, where floats come near to it only
    motion = with_enclosed_frames(proof.motion, framework, [frame(time) for time in times])
    if motion is None:
        return replace(proof, status=UNDECIDED, reason=_STRAYED)
    return replace(proof, motion=motion)
