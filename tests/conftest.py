"""What holds for all tests."""

import os

# Tests start many processes. If they may not keep what they compile, each compiles exactfold again.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
