"""The registry of solvers: all have one signature, and users can register their own."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol, overload

from exactfold._support.progress import Steps
from exactfold.errors import SolverError, UsageError

if TYPE_CHECKING:
    from exactfold.rigidity.equations.branch_system import Chart
    from exactfold.solve.numeric.candidates import Candidates

# Each solver imports its modules when it is called, so that the names alone load fast.

NEWTON = "newton"
"""Newton's method, one start for each sign vector: the solver of `BranchBlocks`."""

ALIASES = {"nappes": NEWTON}
"""Earlier names of methods, still accepted."""

_NAME = re.compile(r"[a-z][a-z0-9_-]*\Z")


class Solver(Protocol):
    """A function (chart, seed, progress) that proposes zeros of the system of a chart.

    `chart.system` holds the quadrics, `chart.branch_system.pattern` the sheet. Equal seeds should
    give equal results. Unless `progress` is None, the solver may call `progress(done, total)` as
    the work advances. The points must be finite and have the shape (m, n). Because of a wrong or
    missing point a proof may fail, but nothing false is ever proved.
    """

    def __call__(self, chart: Chart, seed: int, progress: Steps | None, /) -> Candidates:
        """Candidates for all zeros, real and complex."""


@dataclass(frozen=True)
class RegisteredSolver:
    """A solver with its name and one line on how it works."""

    name: str
    solver: Solver
    description: str
    is_built_in: bool = False


_registered: dict[str, RegisteredSolver] = {}


def register_solver(name: str, solver: Solver, *, description: str) -> None:
    """Register a solver as a method of `count_branches` and `find_candidates`.

    `name` consists of small letters, digits, "-" and "_". The registry belongs to the process: a
    script that starts other processes must register the solver in each. Raises `UsageError` for a
    name that is taken, for "auto" and earlier names of methods, and for a solver that cannot be
    called.

    >>> import numpy as np
    >>> from exactfold.solve.numeric.candidates import Candidates
    >>> def nothing(chart, seed, progress):
    ...     return Candidates("nothing", np.empty((0, chart.system.size), dtype=complex))
    >>> register_solver("nothing", nothing, description="finds no zero")
    >>> "nothing" in METHODS, solvers()["nothing"].description
    (True, 'finds no zero')
    >>> unregister_solver("nothing")
    """
    if not isinstance(name, str) or not _NAME.match(name):
        raise UsageError(f"{name!r} cannot name a solver: use small letters, digits, - and _")
    if name in (*METHODS, *ALIASES):
        raise UsageError(f"there is a method {name!r} already: choose another name")
    if not callable(solver):
        raise UsageError(f"the solver {name!r} cannot be called: it is a {type(solver).__name__}")
    _registered[name] = RegisteredSolver(name, solver, description)


def unregister_solver(name: str) -> None:
    """Remove a solver that `register_solver` added; raises `UsageError` for any other name."""
    if name not in _registered or _registered[name].is_built_in:
        raise UsageError(f"no solver {name!r} was registered")
    del _registered[name]


def solvers() -> dict[str, RegisteredSolver]:
    """All solvers by name, those of exactfold first.

    >>> list(solvers())
    ['newton', 'popping', 'homotopy', 'groebner']
    """
    return dict(_registered)


class _Methods(Sequence[str]):
    """ "auto" and the current names of all solvers; equal to the tuple of these names."""

    def __iter__(self) -> Iterator[str]:
        return iter(("auto", *_registered))

    def __len__(self) -> int:
        return 1 + len(_registered)

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[str, ...]: ...
    def __getitem__(self, index: int | slice) -> str | tuple[str, ...]:
        return tuple(self)[index]

    def __eq__(self, other: object) -> bool:
        return tuple(self) == (tuple(other) if isinstance(other, _Methods) else other)

    def __repr__(self) -> str:
        return repr(tuple(self))


METHODS: Sequence[str] = _Methods()
"""What `method` may be: "auto" and the names in the registry."""


@dataclass(frozen=True)
class Choice:
    """A method and the reason why it was chosen."""

    method: str
    why: str


def choose(method: str) -> Choice:
    """The method to start with; "auto" chooses Newton's method, which suits every D = 1 pattern.

    Raises `UsageError` for a method that is neither in `METHODS` nor an earlier name of one.

    >>> choose("auto").method, choose("nappes").method
    ('newton', 'newton')
    """
    if method == "auto":
        return Choice(NEWTON, "one start for each vector of vertex signs")
    method = ALIASES.get(method, method)
    if method not in METHODS:
        raise UsageError(f"unknown method {method!r}: choose one of {', '.join(METHODS)}")
    return Choice(method, "as asked for")


def find_candidates(
    chart: Chart, method: str = "auto", *, seed: int = 0, progress: Steps | None = None
) -> Candidates:
    """Candidates for all zeros of the system of a chart; no method is trusted to find them.

    `method` is one of `METHODS`. Among the solvers of exactfold only the complex homotopy uses
    `seed`. The solver may call `progress(done, total)` as the work advances. If a pattern is beyond
    the range of floats, or a registered solver raises an exception, there are no candidates, and
    `lost` has the reason. Raises `UsageError` for an unknown method or a negative seed,
    `SolverError` if a solver returns anything but finite points of the right shape.

    >>> from exactfold.pattern.families import two_vertex
    >>> from exactfold.rigidity.equations.branch_system import BranchSystem
    >>> chart = BranchSystem(two_vertex()).chart
    >>> [len(find_candidates(chart, method).points) for method in METHODS]
    [4, 4, 4, 4, 4]
    """
    import numpy as np

    from exactfold.solve.numeric.candidates import Candidates

    chosen = _registered[choose(method).method]
    if seed < 0:
        raise UsageError(f"the seed must not be negative: {seed}")
    size = chart.system.size
    if size == 0:  # without unknowns there is exactly one point
        return Candidates(chosen.name, np.zeros((1, 0), dtype=np.complex128))
    report = _Reported(progress)
    try:
        with np.errstate(all="ignore"):
            candidates = chosen.solver(chart, seed, None if progress is None else report)
    except Exception as error:
        if report.failed or isinstance(error, MemoryError):
            raise
        if isinstance(error, ArithmeticError | np.linalg.LinAlgError):
            why = f"{chosen.name} left the range of floats: {error}"
        elif chosen.is_built_in:
            raise
        else:
            why = f"{chosen.name} failed: {type(error).__name__}: {error}"
        return Candidates(chosen.name, np.zeros((0, size), dtype=np.complex128), (why,))
    return _checked(chosen.name, candidates, size)


class _Reported:
    """A progress function that remembers whether it raised, as the solver did not fail then."""

    def __init__(self, progress: Steps | None) -> None:
        self.progress = progress
        self.failed = False

    def __call__(self, done: int, total: int) -> None:
        if self.progress is None:
            return
        try:
            self.progress(done, total)
        except BaseException:
            self.failed = True
            raise


def _checked(name: str, returned: Any, size: int) -> Candidates:
    """What a solver returned, as `Candidates` with its name; a bad result is a `SolverError`."""
    import numpy as np

    from exactfold.solve.numeric.candidates import Candidates

    if not isinstance(returned, Candidates):
        kind = type(returned).__name__
        raise SolverError(f"the solver {name!r} returned a {kind}, not Candidates")
    try:
        points = np.asarray(returned.points, dtype=np.complex128)
    except (TypeError, ValueError) as error:
        raise SolverError(
            f"the points of the solver {name!r} are not an array of complex numbers: {error}"
        ) from None
    if points.ndim != 2 or points.shape[1] != size:
        raise SolverError(
            f"the points of the solver {name!r} have shape {points.shape}, not (m, {size})"
        )
    bad = int((~np.isfinite(points)).any(axis=1).sum())
    if bad:
        raise SolverError(f"{bad} points of the solver {name!r} are not finite")
    if isinstance(returned.lost, str) or not all(isinstance(text, str) for text in returned.lost):
        raise SolverError(f"`lost` of the solver {name!r} is not a sequence of texts")
    if not isinstance(returned.settings, Mapping) or not all(
        isinstance(key, str) and isinstance(value, int | str)
        for key, value in returned.settings.items()
    ):
        raise SolverError(
            f"`settings` of the solver {name!r} do not map names to integers or texts"
        )
    return replace(returned, method=name, points=points, lost=tuple(returned.lost))


# --- the solvers of exactfold --------------------------------------------------------------------


def _newton(chart: Chart, seed: int, progress: Steps | None) -> Candidates:
    from exactfold.solve.numeric.newton import newton

    return newton(chart, progress=progress).finite()


def _popping(chart: Chart, seed: int, progress: Steps | None) -> Candidates:
    from exactfold.solve.numeric.popping import popping

    return popping(chart, progress=progress).finite()


def _homotopy(chart: Chart, seed: int, progress: Steps | None) -> Candidates:
    from exactfold.solve.numeric.homotopy import homotopy

    return homotopy(chart.system, seed=seed, progress=progress).finite()


def _groebner(chart: Chart, seed: int, progress: Steps | None) -> Candidates:
    from exactfold.solve.algebraic.groebner_bases import groebner

    return groebner(chart.system).candidates


for _name, _solver, _description in (
    (NEWTON, _newton, "Newton's method, one start for each vector of vertex signs"),
    ("popping", _popping, "a real path for each vector of vertex signs"),
    ("homotopy", _homotopy, "a complex path for each of the 2^n zeros of the Bezout number"),
    ("groebner", _groebner, "exact elimination; zeros of any multiplicity"),
):
    _registered[_name] = RegisteredSolver(_name, _solver, _description, is_built_in=True)
