"""`python -m exactfold`: the command line."""

from exactfold.cli import main

main()
