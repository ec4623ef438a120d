"""The package when its folder, or a zip of it, is run by its path.

Python then puts the folder on the import path and knows no package. A module with a `__path__` is
one: its modules are imported as `exactfold_checker.sheet` and so on, here and in worker processes.
"""

from os.path import dirname

__path__ = [dirname(__file__)]
