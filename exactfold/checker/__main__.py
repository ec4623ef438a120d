"""`python exactfold/checker FILE`, `python -m exactfold.checker FILE`, or the same as a zipapp."""

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING or __package__:
    from .command import main
else:  # the folder, or a zip of it, is run by its path and stands first on the import path
    from exactfold_checker.command import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
