"""The command that runs studies."""

from __future__ import annotations

from typing import Any

from exactfold.app.options.studies import StudyOptions
from exactfold.app.shell.usage import taking


@taking(StudyOptions)
def study(**options: Any) -> int:
    """Run a study: a table or figure of the paper, each number in it proved.

    Rows are kept as they are ready; the same command goes on after an
    interruption, and computes no row twice. The result depends on the seed, not
    on the number of processes.
    """
    from exactfold.app.commands.study import Wanted

    return Wanted(**options).answer()


COMMANDS = (study,)
"""In the order in which the help lists them."""
