"""Run the checker: `python exactfold/checker FILE` or `python -m exactfold.checker FILE`."""

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING or __package__:
    from .command import main
else:  # Python runs the folder, or a zip of it, by its path and puts it first on the import path
    from exactfold_checker.command import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
