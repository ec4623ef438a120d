"""The commands that look at single branches."""

from __future__ import annotations

from typing import Any

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.options.branches import (
    AssignmentsOptions,
    BranchOptions,
    ExportOptions,
    MatchOptions,
)
from exactfold.app.shell.shell import EXIT
from exactfold.app.shell.usage import taking

# Each command imports what it needs, as in `cli`.


@taking(BranchOptions)
def branch(**options: Any) -> int:
    """Find and prove the one branch with given vertex signs, and no other.

    Signs are those of the side with boundary saddle +1 (with a reflex corner:
    on which the corner pops up); the other side has all of them reversed. With
    more corners they are those of the way with these heights of the border, or of
    one on which folds start in the ratio of --drive. With --json, one object a line.
    """
    from exactfold.app.commands.branch import Asked

    return EXIT[PROVED if Asked(**options).answer() else UNDECIDED]


@taking(MatchOptions)
def match(**options: Any) -> int:
    """Find the ways to start folding that have the mountains and valleys of a file, with proof.

    All of them; or that there is none and why, and then those that differ at the
    fewest creases. Exit code 1: proved that there is none.
    """
    from exactfold.app.commands.match import Asked

    return Asked(**options).answer()


@taking(ExportOptions)
def export(**options: Any) -> int:
    """Write one branch as a FOLD file that simulators can fold, or a sheet for Coq.

    The fold angles in it are in proportion to those of the branch, so that a
    simulator that is driven by them stays on it. A second frame shows the sheet
    in space, to second order. With --coq the file is one that Coq verifies: what
    is proved of every sheet is stated for this one, and of the branches asked for.
    """
    from exactfold.app.commands.export import Wanted, write_coq

    asked = Wanted(**options)
    return write_coq(asked) if asked.coq else asked.answer()


@taking(AssignmentsOptions)
def assignments(**options: Any) -> int:
    """List every mountain-valley assignment with which a sheet with five corners starts to fold.

    For a convex border of five vertices and up to six vertices inside that can
    pop. The list is proved to be complete. With four corners, `count` lists
    them with the branches.
    """
    from exactfold.app.commands.assignments import Listed

    return Listed(**options).answer()


COMMANDS = (branch, match, assignments, export)
"""In the order in which the help lists them."""
