"""`prove_panels`: the proof that panels fold as they were followed, and of what touches first."""

from __future__ import annotations

import os
from dataclasses import dataclass

from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.certificates.entries import Document, write_certificate
from exactfold.errors import NotApplicableError
from exactfold.motion.claims import Claim
from exactfold.motion.curves.events import STOP, Event
from exactfold.motion.curves.motion_document import PanelProofDocument
from exactfold.motion.panels.certificate import certificate_of_panel_motion
from exactfold.motion.panels.clearance import PanelClearance, with_proved_contact
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.reaching import with_proved_stop

_NAMED = 3
_AT_ONCE = 1e-9


@dataclass(frozen=True, repr=False)
class PanelProof:
    """What is proved of a motion of panels: that they fold in this way, and what touches first.

    `motion` has the first contact as it is proved; if it is not proved, the motion is unchanged.
    `contacts` says until when no two panels touch; it is None if nothing is proved of the motion.
    `certified` says whether there is a certificate, and `layers` is what it claims of the state in
    which all folds close together; None if nothing. `status` is PROVED if the whole motion is clear
    or its first contact is enclosed. Otherwise `reason` says what is missing. `stop` is the stop at
    which the motion ends, with proved bounds of its time.
    """

    status: Verdict
    reason: str
    motion: PanelMotion
    contacts: PanelClearance | None = None
    certified: bool = False
    layers: Claim | None = None
    stop: Event | None = None

    @property
    def passed(self) -> bool:
        """Whether the motion goes on after its first contact, so that panels pass through each
        other.
        """
        contacts = self.contacts
        return (
            contacts is not None
            and contacts.event is not None
            and contacts.event.time[1] < self.motion.duration - _AT_ONCE
        )

    def certificate(self) -> Document:
        """The certificate of what is proved, for `exactfold.check` and `write_certificate`.

        Raises `NotApplicableError` where nothing is proved that a certificate could state.
        """
        if self.contacts is None or not self.certified:
            raise NotApplicableError(f"there is no certificate: {self.reason}")
        return certificate_of_panel_motion(self.motion, self.contacts, self.layers)

    def write(self, path: str | os.PathLike[str]) -> bool:
        """Write `certificate`; False if there is none. Raises `UnwritableFileError`.

        >>> import os, tempfile
        >>> from exactfold.checker import summary, verify
        >>> from exactfold.motion.panels.following import follow_panels
        >>> from exactfold.pattern.families import single_vertex
        >>> from exactfold.pattern.opening import panels
        >>> proof = prove_panels(follow_panels(panels(single_vertex(4)), until="90deg"))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "proof")
        ...     proof.write(path), summary(verify(path))[:44]
        (True, 'VALID: the panels fold, 4 folds move of 4, d')
        """
        try:
            write_certificate(self.certificate(), path)
        except NotApplicableError:
            return False
        return True

    def to_dict(self) -> PanelProofDocument:
        """The object of the proof in the output of `exactfold fold --json`."""
        contacts = self.contacts
        event = None if contacts is None else contacts.event
        return {
            "status": str(self.status),
            "reason": self.reason,
            "tubes": None,
            "length": None,
            "clear": None if contacts is None else contacts.clear,
            "contact": None if event is None else event.to_dict(),
            "through": [],
            "node": None,
            "reached": None,
            "to": None,
            "stop": None if self.stop is None else self.stop.to_dict(),
        }

    def __repr__(self) -> str:
        return f"<PanelProof: {self.status}, {self.contacts!r}>"


def prove_panels(motion: PanelMotion) -> PanelProof:
    """Prove a motion of panels as far as it was followed (docs/motion.md, 20 to 22).

    It is proved that the panels fold in this way, and for how long no two of them touch. If the
    motion meets a contact, that is proved, too, with bounds of its time. UNDECIDED does not mean
    that the motion is wrong.

    >>> from exactfold.motion.panels.following import follow_panels
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> prove_panels(follow_panels(panels(single_vertex(4)), until="90deg"))
    <PanelProof: proved, <PanelClearance: proved, clear until 1.5708>>
    """
    try:
        moved, contacts = with_proved_contact(motion)
    except NotApplicableError as error:
        return PanelProof(UNDECIDED, str(error), motion)
    stop = None
    if moved.end == STOP:
        moved, stop = with_proved_stop(moved)
        if stop is None:
            reason = "it is not proved when the first fold reaches its stop"
            return PanelProof(UNDECIDED, reason, moved, contacts)
    try:
        certificate_of_panel_motion(moved, contacts)
    except NotApplicableError as error:
        return PanelProof(UNDECIDED, str(error), moved, contacts, stop=stop)
    reason = "" if contacts.status is PROVED else _open(contacts)
    return PanelProof(contacts.status, reason, moved, contacts, certified=True, stop=stop)


def _open(contacts: PanelClearance) -> str:
    """Which panels are not proved to stay apart, and after which time."""
    pairs = [
        " and ".join("-".join(map(str, panel)) for panel in pair) for pair in contacts.open_panels
    ]
    more = f", and {len(pairs) - _NAMED} more pairs" if len(pairs) > _NAMED else ""
    if not pairs:
        return f"the positions are not known well enough after the time {contacts.clear:.6g}"
    return (
        f"panels {', '.join(pairs[:_NAMED])}{more} are not proved to stay apart after the time "
        f"{contacts.clear:.6g}"
    )
