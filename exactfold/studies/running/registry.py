"""The studies by name; each is a module of this room with a constant `STUDY`."""

from __future__ import annotations

from importlib import import_module

from exactfold.errors import UsageError
from exactfold.studies.running.study import Study

MODULES = {
    "table1": "exactfold.studies.table1",
    "h1": "exactfold.studies.h1",
    "angles": "exactfold.studies.angles.study",
    "mv": "exactfold.studies.mv",
    "perturbed": "exactfold.studies.perturbed",
    "selffold": "exactfold.studies.selffold",
    "selffold-panels": "exactfold.studies.selffold_panels",
    "flat": "exactfold.studies.flat",
    "motions": "exactfold.studies.loops",
    "tessellations": "exactfold.studies.tessellations",
    "figures": "exactfold.studies.figures",
}
"""The module of each study, in the order in which they are listed."""


def study_named(name: str) -> Study:
    """The study with this name; raises `UsageError`, which lists the names.

    >>> study_named("table1").numbers[5]
    1000
    """
    if name not in MODULES:
        raise UsageError(f"there is no study {name!r}; the studies are: {', '.join(MODULES)}")
    study: Study = import_module(MODULES[name]).STUDY
    return study


def all_studies() -> dict[str, Study]:
    """All studies by name."""
    return {name: study_named(name) for name in MODULES}
