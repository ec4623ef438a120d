"""Forged motions, quickly: pieces that a forgery leaves as they are are proved once."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import cache
from typing import Any

import pytest

from exactfold.checker.motion import certificate as motion
from exactfold.checker.motion import chain as motion_chain
from exactfold.checker.motion import contacts as motion_contacts
from exactfold.checker.motion import nodes as motion_nodes
from exactfold.checker.motion.branch_points import BranchPointTube
from exactfold.checker.motion.lengths import stretches_of
from exactfold.checker.motion.ray import Ray
from exactfold.checker.motion.tubes import Piece


@contextmanager
def pieces_once() -> Iterator[None]:
    """Pieces of one description are proved once, wherever they are entered and left."""
    with pytest.MonkeyPatch.context() as patch:
        for name in ("read_sheet", "emptied_sheet", "equations_of"):
            patch.setattr(motion, name, _once(getattr(motion, name)))
        for name in ("first_piece", "tube_of"):
            patch.setattr(motion_chain, name, _once(getattr(motion_chain, name)))
        arc_of = _once(motion_nodes.arc_of)
        for module in (motion_chain, motion_nodes):
            patch.setattr(module, "arc_of", arc_of)
        patch.setattr(Ray, "begin", lambda *given_: None)  # no name is forged here
        patch.setattr(motion_contacts, "stretches_of", _once(stretches_of))
        for method in ("enclosure", "velocity"):
            patch.setattr(Piece, method, cache(getattr(Piece, method)))
        patch.setattr(BranchPointTube, "configuration", cache(BranchPointTube.configuration))
        yield


def _once(make: Callable[..., Any]) -> Callable[..., Any]:
    known: dict[Any, Any] = {}

    def made(*given_: Any) -> Any:
        key = _key(given_)
        if key not in known:
            known[key] = make(*given_), given_  # what has an id lives as long
        return known[key][0]

    return made


def _key(value: Any) -> Any:
    """The same for two descriptions of a piece, wherever it is entered; of an object its place."""
    if isinstance(value, (list, tuple)):
        return tuple(map(_key, value))
    if isinstance(value, dict):
        within = {k: x for k, x in value.items() if k not in ("entry", "exit")}
        return json.dumps(within, default=str)
    return value if isinstance(value, (int, str, Fraction, type(None))) else id(value)
