"""The commands that fold sheets, and drive them."""

from __future__ import annotations

from typing import Any

from exactfold.app.options.motions import ActuateOptions, FoldOptions, MotionsOptions
from exactfold.app.shell.usage import taking

# Each command imports what it needs, as in `cli`.


@taking(FoldOptions)
def fold(**options: Any) -> int:
    """Fold a sheet in space, faces rigid, until something happens.

    A triangulated sheet with four corners follows a branch: the one named by
    --signs, --up or --branch, else that on which all vertices pop up. With more
    corners it does so if --signs, --up or --rim is given (its border then moves
    in the ratio of the rim), or --drive (chosen folds then drive it). Any other
    sheet follows modes of rigid panels: --component or --modes. That the branch
    or mode exists is proved; the answer says what is proved of the motion.
    """
    from exactfold.app.commands.fold import Wanted

    return Wanted(**options).answer()


@taking(MotionsOptions)
def motions(**options: Any) -> int:
    """Follow every branch, with proof, until the sheet is flat again.

    A sheet with n foldable vertices leaves the flat state along 2^(n+1)
    half-branches. True motions join them in pairs, contact ignored: this says
    which with which.
    """
    from exactfold.app.commands.loops import Wanted

    return Wanted(**options).answer()


@taking(ActuateOptions)
def actuate(**options: Any) -> int:
    """Find torques on the creases that drive the sheet along one branch and not along the others.

    All torques have size at most 1, and a positive one folds towards a valley.
    The sheet is driven to the side on which the vertex signs are those given;
    opposite torques drive it to the other side.
    """
    from exactfold.app.commands.actuate import Driven

    return Driven(**options).answer()


COMMANDS = (fold, motions, actuate)
"""In the order in which the help lists them."""
