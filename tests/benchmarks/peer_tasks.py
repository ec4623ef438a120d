"""The parts of `peers.py` that need exactfold, each in a process of its own.

    python peer_tasks.py TASK SIZE SEED

reads and writes files in the current folder and prints what it found as JSON.
"""

from __future__ import annotations

import json
import platform
import random
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from peer_programs import PEERS, decimals, macaulay2_input, phcpack_input

from exactfold.branches import certificate, count_branches, find_branch
from exactfold.branches.certificates.check import check_compact
from exactfold.branches.counting.stream import stream_branches
from exactfold.branches.values.roots import BoxRoot
from exactfold.certificates import write_certificate
from exactfold.interop.export import to_msolve
from exactfold.pattern.fold import read_fold
from exactfold.pattern.triangulating.random_squares import sample_random_square
from exactfold.pattern.writing.fold_writing import write_fold
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.from_roots import parametrisation_from_roots
from exactfold.solve.algebraic.lifting import lifted_classes
from exactfold.solve.numeric.popping import popping

Found = dict[str, Any]
FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

LARGEST_RESIDUAL = 1e-9
"""Of a quadric, in units of the sum of the sizes of its terms."""

_DUPLICATES = 1e-9
_LARGEST_PARAMETRISED = 10


def machine(size: int, seed: int) -> Found:
    """What this runs on, and which other programs are installed."""
    packages = ("numpy", "scipy", "python-flint")
    return {
        "versions": {"Python": platform.python_version()} | {p: version(p) for p in packages},
        "binaries": {peer.name: peer.find() for peer in PEERS},
    }


def export(size: int, seed: int) -> Found:
    """The pattern and its system, `boundary saddle = 1`, for everybody."""
    many = size > 64
    sample = sample_random_square(size, seed, 1 << 20 if many else 1024, redraw=many)
    write_fold(sample.pattern, "pattern.fold")
    if many:
        return {}
    if sample.pattern.Vt:
        raise SystemExit("a pattern with triangulated triangles has multiple solutions")
    system = BranchSystem(sample.pattern).chart.system
    lines = decimals(system.matrices)
    Path("system.ms").write_text(to_msolve(system), encoding="ascii")
    Path("system.phc").write_text(phcpack_input(lines), encoding="ascii")
    Path("system.m2").write_text(macaulay2_input(lines), encoding="ascii")
    return {}


def count(size: int, seed: int) -> Found:
    """`count_branches` and its certificate."""
    pattern = read_fold("pattern.fold")
    begun = solved = time.process_time()

    def progress(stage: str, done: int, total: int) -> None:
        nonlocal solved
        if stage == "solving":
            solved = time.process_time()

    result = count_branches(pattern, progress=progress)
    made = certificate(result)
    ended = time.process_time()
    write_certificate(made, "certificate.txt")
    roots = [branch.root for branch in result.branches]
    boxes = [root.box for root in roots if isinstance(root, BoxRoot)]
    np.save("proved.npy", [[x / (1 << box.bits) for x in box.real] for box in boxes])
    return {
        "found": result.distinct if str(result.status) == "proved" else 0,
        "stages": {"solve": solved - begun, "certify": ended - solved},
    }


def stream(size: int, seed: int) -> Found:
    """The streaming pipeline on one core."""
    result = stream_branches(read_fold("pattern.fold"), "compact.txt")
    stages = result.cpu_seconds
    return {
        "found": result.distinct or 0,
        "stages": {"solve": stages["solve"], "certify": stages["certify"] + stages["exactly"]},
    }


def check(size: int, seed: int) -> Found:
    """The compact certificate checked, in floats with bounded rounding errors."""
    begun = time.process_time()
    claims = check_compact("compact.txt")
    return {"found": claims["distinct"], "stages": {"check": time.process_time() - begun}}


def lifting(size: int, seed: int) -> Found:
    """The exact solution by lifting from a prime field; None beyond its reach."""
    classes = lifted_classes(BranchSystem(read_fold("pattern.fold")).chart.system)
    return {"found": None if classes is None else sum(one.degree for one in classes)}


def parametrise(size: int, seed: int) -> Found:
    """The exact solution from approximate roots; None where it would take a quarter of an hour."""
    if size > _LARGEST_PARAMETRISED:
        return {"found": None}
    chart = BranchSystem(read_fold("pattern.fold")).chart
    found = parametrisation_from_roots(chart.system, popping(chart))
    return {"found": 0 if found is None else found.degree}


def branch(size: int, seed: int) -> Found:
    """One branch on demand, of random signs."""
    begun = time.process_time()
    pattern = read_fold("pattern.fold")
    read = time.process_time()
    result = find_branch(pattern, _signs(size, seed))
    ended = time.process_time()
    heights = result.approx_heights
    np.save("branch.npy", [heights[v] for v in range(len(pattern.vertices))])
    return {
        "found": int(str(result.status) == "proved"),
        "undecided folds": len(result.undecided_folds),
        "stages": {"read": read - begun, "find": ended - read},
    }


def plain(size: int, seed: int) -> Found:
    """The same branch by `plain_splu.py`; found if its heights agree with those proved."""
    from plain_splu import plain_branch

    pattern, proved = read_fold("pattern.fold"), np.load("branch.npy")
    [rim] = [v for v in pattern.boundary if proved[v] == 1.0]
    signs = np.array([1.0 if sign == "+" else -1.0 for sign in _signs(size, seed)])
    begun = time.process_time()
    try:
        heights, steps = plain_branch(pattern, signs, rim)
    except (ArithmeticError, RuntimeError) as reason:  # the path stalled, a matrix was singular
        stages = {"find": time.process_time() - begun}
        return {"found": 0, "reason": str(reason), "stages": stages}
    error = float(np.abs(heights - proved).max() / np.abs(proved).max())
    return {
        "found": int(error < 1e-6),
        "error": error,
        "steps": steps,
        "stages": {"find": time.process_time() - begun},
    }


def _signs(size: int, seed: int) -> str:
    return "".join(random.Random(seed).choices("+-", k=size))


def judge(size: int, seed: int) -> Found:
    """What the answer of each peer is worth, by the exact coefficients."""
    system = BranchSystem(read_fold("pattern.fold")).chart.system
    proved = np.load("proved.npy")
    answers: Found = {}
    for peer in PEERS:
        file = Path(peer.answer)
        if not file.exists():
            continue
        try:
            rows = np.array(peer.read(file.read_text(encoding="ascii", errors="replace")))
            points = rows.reshape(-1, system.size).astype(complex)
        except (ValueError, KeyError, TypeError, IndexError) as error:
            answers[peer.name] = {"found": 0, "reason": f"answer not understood: {error}"}
            continue
        answers[peer.name] = judged(system, proved, points)
    return {"answers": answers}


def judged(system: QuadraticSystem, proved: FloatArray, points: ComplexArray) -> Found:
    """How many different solutions there are among points, and whether they are those proved.

    A point counts if every quadric is at most `LARGEST_RESIDUAL` there, relative to the sum of the
    sizes of its terms, and if no other point is as near as rounding. `same`: each of the boxes
    proved by exactfold has a point of its own, nearer than half the way to the next box.
    """
    from scipy.spatial import cKDTree  # here: no other task needs it, and it takes a while

    residuals = backward_errors(system, points)
    good = points[residuals <= LARGEST_RESIDUAL]
    if not len(good):
        return {"found": 0, "reason": "no solution"}
    tree = cKDTree(np.hstack([good.real, good.imag]))
    near = tree.query_pairs(_DUPLICATES * float(np.abs(proved).max()), output_type="ndarray")
    distance, owner = tree.query(np.hstack([proved, np.zeros_like(proved)]))
    gap = cKDTree(proved).query(proved, k=2)[0][:, 1]
    return {
        "found": len(good) - len({int(pair[1]) for pair in near}),
        "same": bool((distance < gap / 2).all() and len(set(owner.tolist())) == len(proved)),
        "largest residual": float(residuals.max()),
    }


def backward_errors(system: QuadraticSystem, points: ComplexArray) -> FloatArray:
    """max over quadrics of |F(x)| / sum |terms|, F(x) in integers, for each complex point x."""
    bits = 128
    finite = np.isfinite(points.real).all(axis=1) & np.isfinite(points.imag).all(axis=1)
    result = np.full(len(points), np.inf)
    for row in np.flatnonzero(finite):
        z = [*points[row].tolist(), 1.0 + 0.0j]
        a, b = [_scaled(x.real, bits) for x in z], [_scaled(x.imag, bits) for x in z]
        worst = 0.0
        for matrix in system.matrices:
            real = imaginary = terms = 0
            for i, line in enumerate(matrix):
                for j, s in enumerate(line):
                    if s:
                        real += s * (a[i] * a[j] - b[i] * b[j])
                        imaginary += s * (a[i] * b[j] + b[i] * a[j])
                        terms += abs(s) * (abs(a[i]) + abs(b[i])) * (abs(a[j]) + abs(b[j]))
            worst = max(worst, (abs(real) + abs(imaginary)) / terms)
        result[row] = worst
    return result


def _scaled(x: float, bits: int) -> int:
    top, bottom = x.as_integer_ratio()
    return (top << bits) // bottom


def profile_count(size: int, seed: int) -> Found:
    """Where the time of `count` goes."""
    return _profiled(lambda: count(size, seed))


def profile_stream(size: int, seed: int) -> Found:
    """Where the time of `stream` goes."""
    return _profiled(lambda: stream(size, seed))


def profile_parametrise(size: int, seed: int) -> Found:
    """Where the time of `parametrise` goes."""
    return _profiled(lambda: parametrise(size, seed))


def profile_branch(size: int, seed: int) -> Found:
    """Where the time of `branch` goes."""
    return _profiled(lambda: branch(size, seed))


def _profiled(work: Callable[[], Found]) -> Found:
    """Shares of the time spent in functions themselves, the largest first."""
    import cProfile
    import pstats

    profile = cProfile.Profile()
    profile.runcall(work)
    entries = pstats.Stats(profile).stats.items()  # type: ignore[attr-defined]
    total = sum(values[2] for _, values in entries)
    own = [(values[2] / total, _place(*key)) for key, values in entries]
    return {"seconds": total, "shares": [list(pair) for pair in sorted(own, reverse=True)[:6]]}


def _place(file: str, line: int, name: str) -> str:
    if file == "~":  # built in
        return name.strip("<>")
    return f"{name} ({'/'.join(Path(file).parts[-2:])})"


TASKS: dict[str, Callable[[int, int], Found]] = {
    task.__name__: task
    for task in (
        machine,
        export,
        count,
        stream,
        check,
        lifting,
        parametrise,
        branch,
        plain,
        judge,
        profile_count,
        profile_stream,
        profile_parametrise,
        profile_branch,
    )
}

if __name__ == "__main__":
    print(json.dumps(TASKS[sys.argv[1]](int(sys.argv[2]), int(sys.argv[3]))))
