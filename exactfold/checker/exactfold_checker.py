"""The package, under a name of its own, when Python runs its folder or a zip of it by the path.

In that case Python puts the folder on the import path, and there is no package. A module with a
`__path__` serves as a package: the modules of the checker are imported as `exactfold_checker.core`
and so on, in this process and in worker processes.
"""

from os.path import dirname

__path__ = [dirname(__file__)]
