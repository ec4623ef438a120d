"""What is known of a motion that the page draws: whether it is proved, and the words for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED
from exactfold.exact.numbers import outward
from exactfold.motion.proving import prove

if TYPE_CHECKING:
    from exactfold.motion.curves.in_motion import SheetInMotion
    from exactfold.motion.curves.motion import Motion
    from exactfold.motion.panels.motion import PanelMotion


class Known(NamedTuple):
    """What is known of a motion: whether what is drawn is proved, whether it exists, in words."""

    proved: bool
    exists: bool
    said: str


def only_floats(motion: SheetInMotion) -> Known:
    """What is known before any proof."""
    return Known(False, False, f"followed in floats; {_kept(motion)}")


def _kept(motion: SheetInMotion) -> str:
    return f"faces stay rigid, to {max(motion.length_error, 1e-16):.0e} of each length"


def proof_of(motion: Motion) -> Known:
    """What is proved of a motion along a branch."""
    proof = prove(motion)
    if proof.status is not PROVED:
        return Known(False, False, f"followed in floats; it could not be proved: {proof.reason}")
    event = None if proof.contact is None else proof.contact.event
    parts = [f"it exists, without a gap, in {counted(proof.tubes, 'tube')}"]
    for text in filter(None, (proof.through_text, proof.end_text)):
        parts[0] += f", {text}"
    if proof.end_text and proof.clear_to_the_end:
        parts.append("no two faces touch before it, nor at it")
    if event is not None:
        low, high = outward(*event.time)
        parts.append(f"its first contact is between the times {low} and {high}")
    return Known(True, True, f"{'; '.join(parts)}; the frames are floats close to it")


def proof_of_panels(motion: PanelMotion, contacts: bool) -> Known:
    """What is proved of a motion of panels, and of its contact if asked (docs/motion.md, 18)."""
    if motion.closes is PROVED:
        said = (
            "every vertex closes exactly at all fold angles"
            if motion.curves
            else "only folds from boundary to boundary turn, and they may turn by any angle"
        )
        touching = _proved_contact(motion) if contacts else "contacts were found in floats"
        return Known(True, True, f"{said}; {touching}")
    if motion.exists is PROVED:
        said = "it exists until a fold reaches 180 degrees, and all angles grow"
        if contacts:
            said = f"{said}; {_proved_contact(motion)}; the drawing is computed in"
        else:
            said = f"{said}; the drawing and the contacts are computed in"
        return Known(False, True, f"{said} floats; {_kept(motion)}")
    return only_floats(motion)


def _proved_contact(motion: PanelMotion) -> str:
    from exactfold.motion.panels.clearance import prove_contacts

    clearance = prove_contacts(motion)
    if clearance.status is not PROVED:
        return f"its contacts are undecided: {clearance.reason}"
    if clearance.event is None:
        return "it is proved that no panels touch on the way"
    low, high = outward(*clearance.event.time)
    return f"its first contact is proved to be between the times {low} and {high}"
