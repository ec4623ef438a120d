"""What `exactfold fold` prints."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, pi
from typing import TYPE_CHECKING, Final

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED
from exactfold.app.report.branch import boundary_heights_text
from exactfold.app.report.terminal import cut, facts_table, letters_text, status_text
from exactfold.exact.numbers import outward
from exactfold.motion.curves.events import (
    ANGLE,
    CHANGE,
    CONTACT,
    DEAD_POINT,
    DRIVEN,
    FLAT_FOLD,
    LENGTH,
    NODE,
    RETURN,
    SINGULAR,
    STOP,
    TURNING,
    Event,
)
from exactfold.motion.curves.motion import Motion
from exactfold.motion.panels.families import FamilyMotion
from exactfold.motion.periodic.rolling import RollingMotion

if TYPE_CHECKING:
    from exactfold.motion.curves.in_motion import SheetInMotion
    from exactfold.motion.panels.motion import PanelMotion
    from exactfold.motion.panels.proving import PanelProof
    from exactfold.motion.proving import MotionProof
    from exactfold.pattern.crease_pattern import Edge

_TURNINGS: Final = 8
_LARGEST: Final = 5
_FOLDS: Final = 6
_CORNERS: Final = 8


def motion_report(
    motion: Motion | PanelMotion | FamilyMotion | RollingMotion,
    written: Sequence[str] = (),
    proof: MotionProof | PanelProof | None = None,
) -> Group:
    """A motion: what it goes along, where and why it ends, its events, and what was written.

    `proof` says what is proved of it, if that was asked for.
    """
    letters = "".join(motion.assignment[fold] for fold in motion.pattern.folds)
    along = _branch_rows(motion) if isinstance(motion, Motion) else _mode_rows(motion)
    rows: list[tuple[str, RenderableType]] = [
        *along,
        ("mountain-valley", letters_text(cut(letters))),
        ("motion", _proved(motion) if proof is None else _proof(proof)),
        ("end", f"time {motion.duration:.6g}: {ending_text(motion)}"),
        ("largest angles", _largest(motion)),
        ("lengths", f"kept to {motion.length_error:.1e} of each"),
        ("frames", _frames(motion)),
    ]
    if len(written) > 4:
        written = [written[0], "...", written[-1]]
    rows += [("wrote" if not k else "", name) for k, name in enumerate(written)]
    return Group(facts_table(rows), *_events(motion))


def _frames(motion: SheetInMotion) -> str:
    text = f"{len(motion.times)}, with face {_face(motion.pinned)} held"
    if motion.bounds is None:
        return text
    return f"{text}; each within {max(motion.bounds.radii):.1e} of a proved configuration"


def _branch_rows(motion: Motion) -> list[tuple[str, RenderableType]]:
    branch = motion.branch
    side = "mirror image: all signs reversed" if motion.side < 0 else "as named"
    rows: list[tuple[str, RenderableType]] = [
        ("branch", Text.assemble(cut(branch.sign_text), ", ", status_text(branch.status))),
        ("side", f"{'-' if motion.side < 0 else '+'} ({side})"),
    ]
    if motion.boundary_heights is not None:
        rows.append(
            ("boundary", f"in the ratio {cut(boundary_heights_text(motion.boundary_heights))}")
        )
    if motion.drive is not None:
        rows.append(("driven", cut(f"{motion.drive.text}; sines of half the angles in ratio")))
    return rows


def _mode_rows(
    motion: PanelMotion | FamilyMotion | RollingMotion,
) -> list[tuple[str, RenderableType]]:
    rows: list[tuple[str, RenderableType]] = [("way", cut(motion.name.removeprefix("way ")))]
    if not isinstance(motion, RollingMotion) and motion.solid is not None:
        limits = {
            f"{name} at most {degrees(motion.solid.limit(letter)):.6g}"
            for name, letter in (("mountains", "M"), ("valleys", "V"))
            if letter in motion.assignment.values()
        }
        text = f"{motion.solid.text}; {', '.join(sorted(limits))} degrees at their hinges"
        rows.append(("plates", cut(text)))
    return rows


def _proof(proof: MotionProof | PanelProof) -> RenderableType:
    """What is proved of a motion, in one or two sentences."""
    if proof.status is not PROVED:
        return Text.assemble(status_text(proof.status), f": {proof.reason}")
    if not isinstance(proof.motion, Motion):
        return _proof_of_panels(proof)
    parts = [f": one curve without a gap, {counted(proof.tubes, 'tube')}"]
    for text in filter(None, (proof.through_text, proof.end_text)):
        parts[0] += f", {text}"
    if proof.reached:
        parts[0] += ", on which the driven angles reach the sizes asked for"
    contact = proof.contact
    if contact is not None and contact.event is None and proof.passed:
        parts.append(f"no two faces touch before {float(contact.clear):.8g}, then some may")
    elif proof.clear_to_the_end:
        parts.append(f"no two faces touch {'before it, nor at it' if proof.end_text else 'on it'}")
    elif contact is not None and contact.event is not None:
        parts.append(_enclosed(contact.event, passed=proof.passed))
    elif proof.back_text:
        parts.append(f"it comes back along {proof.back_text}")
    return Text.assemble(status_text(proof.status), "; ".join(parts))


def _proof_of_panels(proof: PanelProof) -> RenderableType:
    """What is proved of a motion of panels."""
    touching = "no two panels touch on it"
    if proof.contacts is not None and proof.contacts.event is not None:
        touching = "no two panels touch before its folds close, at time pi"
        if proof.contacts.clear < pi:
            touching = _enclosed(proof.contacts.event, passed=proof.passed)
    if proof.stop is not None:
        touching += f"; {event_text(proof.stop)} {_between(proof.stop)}"
    return Text.assemble(status_text(PROVED), f": {proof.motion.reason}; {touching}")


def _enclosed(event: Event, *, passed: bool) -> str:
    """Bounds of the time of a first contact."""
    after = ", where the motion goes on" if passed else ""
    return f"the first contact is {_between(event)}{after}"


def _between(event: Event) -> str:
    """Bounds of the time of an event."""
    low, high = outward(*event.time)
    return f"between the times {low} and {high}"


def _proved(motion: Motion | PanelMotion | FamilyMotion | RollingMotion) -> RenderableType:
    if isinstance(motion, Motion):
        return "followed in floats: not proved (--certificate proves it)"
    if isinstance(motion, FamilyMotion | RollingMotion):
        return motion.reason
    if motion.exists is not PROVED:
        return "followed in floats: not proved"
    if motion.closes is not PROVED:
        said = ": it exists until a fold reaches 180 degrees; its angles and contacts are floats"
        return Text.assemble(status_text(PROVED), said)
    return Text.assemble(
        status_text(PROVED), f": {motion.reason}; contacts are not (--certificate proves them)"
    )


def ending_text(motion: SheetInMotion) -> str:
    """Why a motion ends, in plain words."""
    last = [event for event in motion.events if event.kind == motion.end]
    if motion.end == LENGTH or not last:
        return "the time that was asked for"
    text = event_text(last[-1])
    if motion.end == NODE:
        text += "; --through-nodes goes on"
    return text


def event_text(event: Event) -> str:
    """An event in plain words, with its faces and folds.

    >>> event_text(Event("contact", (0.5, 0.5), ((1, 2, 3), (4, 5, 6)), detail="edge on edge"))
    'faces 1-2-3 and 4-5-6 meet (edge on edge)'
    """
    folds = _folds(event.folds)
    detail = f" ({event.detail})" if event.detail else ""
    if event.kind == CONTACT:
        return f"faces {' and '.join(map(_face, event.faces))} meet{detail}"
    several = len(event.folds) > 1
    words = {
        FLAT_FOLD: f"{folds} close: faces meet"
        if several
        else f"{folds} closes: its two faces meet",
        TURNING: f"{folds} {'turn' if several else 'turns'} back{detail}",
        CHANGE: f"{folds} {'change' if several else 'changes'} {event.detail}",
        ANGLE: f"{folds} {'have' if several else 'has'} the angle that was asked for",
        DRIVEN: f"{folds} {'have' if several else 'has'} the angles of the drive",
        DEAD_POINT: f"{folds} {'turn' if several else 'turns'} back: they cannot be driven further",
        NODE: f"another motion crosses here{detail}",
        RETURN: "the sheet is flat again",
        STOP: f"{folds} {'reach their stops' if several else 'reaches its stop'}",
        SINGULAR: f"it could not be followed further{detail}",
    }
    return words[event.kind]


def _folds(folds: Sequence[Edge]) -> str:
    named = ", ".join(f"{i}-{j}" for i, j in folds[:_FOLDS])
    more = f" and {len(folds) - _FOLDS} more" if len(folds) > _FOLDS else ""
    return f"{'folds' if len(folds) > 1 else 'fold'} {named}{more}"


def _face(face: Sequence[int]) -> str:
    return "-".join(map(str, face[:_CORNERS])) + ("-..." if len(face) > _CORNERS else "")


def _largest(motion: SheetInMotion) -> str:
    angles, folds = motion.largest_angles, motion.pattern.folds
    order = np.argsort(-np.round(np.abs(angles), 6), kind="stable")[:_LARGEST]  # ties by fold
    shown = ", ".join(f"{folds[k][0]}-{folds[k][1]} {angles[k]:.4g}" for k in order)
    more = "" if len(folds) <= _LARGEST else ", ..."
    return f"{shown}{more} degrees"


def _events(motion: SheetInMotion) -> list[RenderableType]:
    """The table of events; if many folds turn back, only the first of them are listed."""
    turning = [event for event in motion.events if event.kind == TURNING]
    left_out = turning[_TURNINGS:]
    shown = [event for event in motion.events if event not in left_out]
    if not shown:
        return []
    table = Table(box=None, pad_edge=False)
    table.add_column("time")
    table.add_column("event")
    table.add_column("what happens", overflow="fold")
    for event in shown:
        table.add_row(f"{event.time[1]:.6g}", event.kind, event_text(event))
    parts: list[RenderableType] = [Text(""), table]
    if left_out:
        number = counted(len(left_out), "more fold")
        verb = "turns" if len(left_out) == 1 else "turn"
        parts.append(Text(f"... and {number} {verb} back (--json lists all)"))
    return parts
