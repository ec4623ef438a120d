"""What holds for all tests."""

import functools
import os

import typer.testing

# Tests start many processes. If they may not keep what they compile, each compiles exactfold again.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Typer prepares all commands again for each command line: once is enough for those of one process.
typer.testing._get_command = functools.cache(typer.testing._get_command)
