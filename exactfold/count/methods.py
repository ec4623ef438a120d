"""Every solver of the branch system behind one signature, and the choice among them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exactfold.algebra.groebner import groebner
from exactfold.errors import UsageError
from exactfold.problem.branch_system import Chart
from exactfold.solve.candidates import Candidates
from exactfold.solve.homotopy import homotopy
from exactfold.solve.newton_ends import nappe_ends
from exactfold.solve.popping import popping

Progress = Callable[[int, int], None]

SOLVERS: dict[str, Callable[[Chart, int, Progress | None], Candidates]] = {
    "nappes": lambda chart, seed, progress: nappe_ends(chart, progress=progress),
    "popping": lambda chart, seed, progress: popping(chart, progress=progress),
    "homotopy": lambda chart, seed, progress: homotopy(chart.system, seed=seed, progress=progress),
    "groebner": lambda chart, seed, progress: groebner(chart.system).candidates,
}
METHODS = ("auto", *SOLVERS)

NEWTON = "nappes"
"""Newton's method, one start for each sign vector: the solver of the conveyor."""


@dataclass(frozen=True)
class Choice:
    """A method and why it was chosen."""

    method: str
    why: str


def choose(method: str) -> Choice:
    """The solver to start with; "auto" takes the nappes, which every pattern with D = 1 has.

    Raises `UsageError` for a method not in `METHODS`.

    >>> choose("auto").method
    'nappes'
    """
    if method not in METHODS:
        raise UsageError(f"unknown method {method!r}: choose one of {', '.join(METHODS)}")
    if method != "auto":
        return Choice(method, "as asked for")
    return Choice("nappes", "one end for each vector of vertex signs")


def find_candidates(
    chart: Chart, method: str = "auto", *, seed: int = 0, progress: Progress | None = None
) -> Candidates:
    """Candidates for all zeros of the system of a chart; untrusted, whatever the method.

    `method` is one of `METHODS`; `seed` is used by the complex homotopy only. `progress(done,
    total)` is called as work advances. A pattern beyond the range of floats gives no candidates,
    and says so in `lost`. Raises `UsageError` for an unknown method or a negative seed.

    >>> from exactfold.pattern.families import two_vertex
    >>> from exactfold.problem.branch_system import BranchSystem
    >>> chart = BranchSystem(two_vertex()).chart
    >>> [len(find_candidates(chart, method).points) for method in METHODS]
    [4, 4, 4, 4, 4]
    """
    chosen = choose(method).method
    if seed < 0:
        raise UsageError(f"the seed must not be negative: {seed}")
    if chart.system.size == 0:  # no equation: the one point there is
        return Candidates(chosen, np.zeros((1, 0), dtype=np.complex128))
    try:
        with np.errstate(all="ignore"):
            return SOLVERS[chosen](chart, seed, progress)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        nothing = np.zeros((0, chart.system.size), dtype=np.complex128)
        return Candidates(chosen, nothing, (f"{chosen} left the range of floats: {error}",))
