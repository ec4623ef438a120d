"""The certificate of a radius within which ways and their letters stay."""

from __future__ import annotations

from fractions import Fraction

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.certificates.entries import Document
from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.checker.sheets.panels import read_panels
from exactfold.checker.tolerance.certificate import TOLERANCE
from exactfold.checker.tolerance.conditions import Conditions
from exactfold.checker.tolerance.zeros import Zero
from exactfold.design.tolerance.result import Tolerance
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_entries import panels_document

_SMALLER = Fraction(15, 16)
_TRIES = 64
_BITS = 50


def tolerance_certificate(found: Tolerance, progress: Progress | None = None) -> Document:
    """The certificate of a tolerance, as a JSON object for `exactfold.checker`.

    It holds the densities of the ways that are kept, from which the checker finds the zeros again
    (docs/tolerance.md, 1). The bounds of the checker are not those of `radius.py`: if they do not
    reach the radius, the largest that they reach is claimed, of those a sixteenth apart.

    Raises `NotApplicableError` for a radius of 0, and for a sheet with several parts, with folds
    that stay flat, with ways that are not real, or with straight corners.

    >>> from exactfold import checker
    >>> from exactfold.branches.counting.collect import count_branches
    >>> from exactfold.design.tolerance.tolerance import tolerance_of_branches
    >>> document = tolerance_certificate(tolerance_of_branches(count_branches("two-vertex")))
    >>> checker.check(document)["ways"]
    ['MMMMMMV', 'MMVVMMV', 'MVVVMVM', 'MVMMMVM']
    """
    if found.status is not PROVED or not found.radius:
        raise NotApplicableError(f"only a radius that is proved has a certificate: {found.reason}")
    if not found.motions:
        raise NotApplicableError(
            "only sheets have a certificate of which all folds belong to one part, with ways that "
            "are all real"
        )
    pattern = found.pattern
    sheet = panels_document(panels(pattern) if isinstance(pattern, CreasePattern) else pattern)
    try:
        conditions = Conditions(read_panels(sheet)[0])
    except (CertificateError, LimitError) as error:
        raise NotApplicableError(str(error)) from None
    densities = [_integers(row) for row in found.motions]
    zeros = []
    for k, row in enumerate(densities):
        if progress is not None:
            progress("certifying", k, len(densities))
        zeros.append(Zero(conditions, [float(c) for c in row]))
    radius = Fraction(found.radius)
    ways: list[str] | None = None
    for _ in range(_TRIES):
        ways = _ways(conditions, zeros, radius)
        if ways is not None:
            break
        radius = Fraction(float(radius * _SMALLER))
    if ways is None:
        raise NotApplicableError("the bounds of the checker do not reach any radius")
    return {
        "format": TOLERANCE.format,
        "version": TOLERANCE.version,
        "pattern": sheet,
        "claims": {
            "radius": format_rational(radius),
            "ways": ways,
            "number": None if found.way else len(ways),
        },
        "evidence": {"densities": densities},
    }


def _ways(conditions: Conditions, zeros: list[Zero], radius: Fraction) -> list[str] | None:
    """The letters of the ways, M first, if the checker accepts the radius."""
    r = conditions.radius(radius)
    if conditions.shape_stays(r):
        return None
    ways = []
    for zero in zeros:
        rho = zero.box(r)
        letters = [""] if rho is None else list(zero.letters(r, rho).values())
        if "" in letters:
            return None
        text = "".join(letters)
        ways.append(min(text, text.translate(str.maketrans("MV", "VM"))))
    return ways


def _integers(row: tuple[float, ...]) -> list[int]:
    largest = max(map(abs, row))
    return [round(c / largest * (1 << _BITS)) for c in row]
