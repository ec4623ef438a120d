"""`prove`: proves a motion that was followed in floats."""

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
"""Binary digits after the point of the numbers in tubes, in the order in which they are tried."""

_AT_ONCE = 1e-9
"""Relative to the duration: contacts this close to the end of a motion are at its end."""
_FARTHER = Fraction(1, 1000)
"""A proof longer than the motion by this fraction has missed the branch point at its end."""
_BEYOND = 1e-8
"""A driven motion is proved longer by this fraction, so that the folds pass their final angles."""
_NAMED = 3
_NO_NODE = "the proof met no branch point where floats see one"
_STRAYED = "the frames in floats are far from the proved curve: floats have left the branch"


@dataclass(frozen=True, repr=False)
class MotionProof:
    """The proof that a motion exists, without a gap, and of its first contact.

    `motion` is the motion with frames of the proved curve and error bounds (`Motion.bounds`). If
    the motion is not proved to its end, it is the motion that was given. `track` is the chain of
    tubes, and `contact` says until when no two faces touch, and which faces touch first, if any do.
    Both are None for a motion until its return, whose proof is `looped`. `passed` is true if the
    motion goes on after the first contact, through the paper, or after the time until which it is
    proved to be clear. `branch_point` is the branch point at which the proof ends, if it ends at
    one (`Track.branch_point`). `length` has bounds for the proved length, in the unit of the sheet.

    `status` is PROVED if the whole motion is proved and, for a motion that ends at a contact, this
    contact. If the motion ends at a branch point, it must also be proved that no two faces touch up
    to this point, unless the motion goes through the paper before. Otherwise `reason` says what is
    missing.
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
        """The outline of the loop, for a motion until its return; otherwise None."""
        return None if self.looped is None else self.looped.outline

    @property
    def branch_point(self) -> Passage | None:
        """The passage to the branch point at which the proof ends; None if it ends elsewhere."""
        return None if self.track is None else self.track.branch_point

    @property
    def through(self) -> tuple[Passage, ...]:
        """The passages through the branch points that the motion goes through."""
        if self.looped is not None:
            return tuple(step for step in self.looped.steps if isinstance(step, Passage))
        return () if self.track is None else self.track.through

    @property
    def clear_to_the_end(self) -> bool:
        """Whether no two faces touch in any proved configuration, including the last one."""
        return self.contact is not None and not self.passed and self.contact.clear_to_the_end

    @property
    def back_text(self) -> str:
        """The ray along which the motion comes back, in words; empty if it does not come back."""
        loop = self.loop
        if loop is None or loop.target is None:
            return ""
        if self.motion.boundary_heights is None:
            return str(loop.target)
        way = "as given" if loop.target.saddle > 0 else "the other way up"
        return f"{loop.target.sign_text}, with the boundary {way}"

    @property
    def reached(self) -> bool | None:
        """Whether the driven angles are proved to reach their final sizes; None without a drive.

        If so, they have at least these sizes at the end, each to its own side (docs/motion.md,
        10). Nothing is said about the one driven fold of a sheet with four corners.
        """
        return None if self.track is None or self.track.drive is None else self.track.reached

    @property
    def through_text(self) -> str:
        """The branch points that the motion goes through, in words; empty if there are none."""
        nodes = [
            f"a branch point at the time {in_floats(self._time_of(branch_point))[1]:.6g}, "
            f"where {branch_point.what}"
            for branch_point in self.through
        ]
        return f"through {' and '.join(nodes)}" if nodes else ""

    @property
    def end_text(self) -> str:
        """The branch point at which the proof ends, in words; empty if it ends elsewhere."""
        if self.branch_point is None:
            return ""
        time = in_floats(self.length)[1]
        return f"until a branch point at the time {time:.6g}, where {self.branch_point.what}"

    @property
    def may_succeed_otherwise(self) -> bool:
        """Whether tubes failed at a place where floats see no singularity.

        Then a proof with other settings may succeed.
        """
        if self.status is PROVED or self.motion.end == SINGULAR:
            return False
        return self.reason != _STRAYED and (self.track is None or self.track.status is not PROVED)

    def certificate(self) -> Document | CertificateLines:
        """The certificate of the proved part, for `exactfold.check` and `write_certificate`.

        If a motion of a sheet with four corners is proved until its return, the certificate is a
        file of loops with this one loop (docs/motion.md, 15). Any other motion has a certificate of
        its own for the part that is proved. It claims nothing about a contact that the motion
        passes.

        Raises `NotApplicableError` if nothing is proved that a certificate could state.

        >>> import exactfold
        >>> proof = exactfold.prove(exactfold.follow("two-vertex", signs="+-", until="return"))
        >>> exactfold.check(proof.certificate()).text[:57]
        'VALID: 1 loop of true motions, which match 4 of 8 rays; s'
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
        """Write the certificate; return False if there is none. Raises `UnwritableFileError`.

        >>> import os, tempfile
        >>> from exactfold.checker import summary, verify
        >>> from exactfold.branches.counting.find import find_branch
        >>> from exactfold.motion.following import follow
        >>> proof = prove(follow(find_branch("two-vertex", "+-"), until="return"))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "proof")
        ...     proof.write(path), summary(verify(path))[:57]
        (True, 'VALID: 1 loop of true motions, which match 4 of 8 rays; s')
        """
        try:
            write_certificate(self.certificate(), path)
        except NotApplicableError:
            return False
        return True

    def to_dict(self) -> ProofDocument:
        """The object that `exactfold fold --json` prints for the proof."""
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
            "stop": None,
        }

    def _time_of(self, branch_point: Passage) -> Interval:
        """Bounds for the time of a branch point, in the unit of the sheet."""
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

    From the flat state to the end of the motion, tubes enclose exactly one configuration for each
    parameter (docs/motion.md), and separating planes show which faces do not touch
    (docs/motion.md, 16). If the motion ends at its first contact, this contact is proved; otherwise
    the proof says until when the motion is clear. If the motion passes through branch points, the
    proof goes on along the same arc (docs/motion.md, 6); if it ends at a branch point, it is proved
    up to this point. The result has the frames of the proved curve, each enclosed in a box
    (`Motion.bounds`). All numbers in the tubes have `bits` binary digits after the point.

    Raises `UsageError` if the branch is not proved. UNDECIDED does not mean that the motion is
    wrong.

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
    passed_contact: FirstContact | None = None
    seen = 0

    def stop(step: Step) -> str | None:
        nonlocal passed_contact, seen
        seen += 1
        if progress is not None:
            progress("proving, tubes", seen, 0)
        if to_branch_point and step.entered[0] * so_far.framework.unit > missed:
            return _NO_NODE
        if passed_contact is not None:
            return None
        said = watch(step)
        if said is None or to_contact:
            return said
        passed_contact = watch.result(so_far)
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
    contact = watch.result(track) if passed_contact is None else passed_contact
    status, reason = _judged(motion, track, contact)
    met = passed_contact is not None or (contact.event is not None and not to_contact)
    passed = met and contact.clear < Fraction(motion.duration)
    proof = MotionProof(status, reason, motion, track.length, track.tubes, track, contact, passed)
    if track.branch_point is not None and status is not PROVED:
        proof = replace(proof, reason=f"proved {proof.end_text}, but {reason}")
    return _with_frames(proof, track.framework, track.frame)


def _judged(motion: Motion, track: Track, contact: FirstContact) -> tuple[Verdict, str]:
    """The verdict on a motion, and what is missing if it is not proved to its end."""
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
        return UNDECIDED, "the motion in floats goes on without a branch point there"
    if track.status is PROVED:
        proved = contact.status is PROVED or not to_contact
        return (PROVED, "") if proved else (UNDECIDED, contact.reason)
    if branch_point is None or track.through:
        return UNDECIDED, track.reason
    time = f"{branch_point.time[1]:.6g}"
    unproved = f"floats see a branch point at the time {time}, which is not proved"
    return UNDECIDED, f"{track.reason}; {unproved}"


def _not_apart(contact: FirstContact) -> str:
    """The sentence that names the faces that are not proved to stay apart."""
    names = [" and ".join("-".join(map(str, face)) for face in pair) for pair in contact.open_faces]
    more = f", and {len(names) - _NAMED} more pairs" if len(names) > _NAMED else ""
    return f"faces {', '.join(names[:_NAMED])}{more} are not proved to stay apart"


def _branch_point_of(motion: Motion) -> Event | None:
    """The first branch point that floats see on a motion."""
    return next((event for event in motion.events if event.kind == NODE), None)


def _passes_branch_points(motion: Motion) -> bool:
    """Whether floats see the motion go on beyond a branch point."""
    return motion.end != NODE and _branch_point_of(motion) is not None


def _ends_at_the_first_contact(motion: Motion) -> bool:
    """Whether the first contact of a motion is at its end."""
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
    """The proof with enclosed frames; UNDECIDED if the motion in floats left the proved curve."""
    if proof.status is not PROVED:
        return proof
    longest = in_floats((proof.length[1], proof.length[1]))[0]
    times = [min(time, longest) for time in proof.motion.times.tolist()]
    if proof.branch_point is not None and proof.motion.end == NODE:
        times[-1] = longest  # the branch point itself, which floats only approach
    motion = with_enclosed_frames(proof.motion, framework, [frame(time) for time in times])
    if motion is None:
        return replace(proof, status=UNDECIDED, reason=_STRAYED)
    return replace(proof, motion=motion)
