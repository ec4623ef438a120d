"""Certificates of bounds for the degrees of freedom of rigid panels, for `exactfold.checker`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from flint import fmpz
from scipy.linalg import null_space

from exactfold._support.verdict import PROVED
from exactfold.certificates.entries import Document
from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.checker.letters.panels_freedom import PANEL_FREEDOM, bounds
from exactfold.checker.sheets.panels import PanelSheet, connected, read_panels
from exactfold.design.panels.certificate import motion_evidence
from exactfold.design.panels.match import PanelMatch
from exactfold.design.panels.parts import PartAnswer
from exactfold.errors import NotApplicableError
from exactfold.panels.result import Decomposition, Part
from exactfold.panels.spaces.freedom import combining
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import Edge

_MODULUS: Final = 2**61
_MOST_PRIMES: Final = 2_000
_TINY: Final = 1e-9


def freedom_certificate(result: Decomposition) -> Document:
    """The certificate of bounds for the degrees of freedom of a sheet, as a JSON object.

    The bounds are those that the checker knows proofs of (docs/panels.md, 6), and may be wider than
    those of `result.freedom`. Raises `NotApplicableError` if the digits of the drawing are in doubt
    or folds are held flat, and where the checker does not find the bounds again.

    >>> from exactfold import checker
    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.pattern.families import waterbomb
    >>> from exactfold.pattern.opening import panels
    >>> document = freedom_certificate(decompose(panels(waterbomb())))
    >>> checker.check(document)["most"]
    3
    """
    if result.doubt or result.held:
        raise NotApplicableError(
            "bounds of the degrees of freedom have a certificate only where no fold is held flat "
            "and the digits of the drawing are not in doubt"
        )
    document = panels_document(result.pattern)
    sheet, _ = read_panels(document)
    moving = stars(result.pattern)
    evidence = {**_family(result, sheet), "apart": _apart(moving), **_modulus(sheet)}
    try:
        claims = bounds(sheet, evidence)
    except (CertificateError, LimitError) as error:
        raise NotApplicableError(f"the checker does not find the bounds again: {error}") from None
    return {
        "format": PANEL_FREEDOM.format,
        "version": PANEL_FREEDOM.version,
        "pattern": document,
        "claims": claims,
        "evidence": evidence,
    }


# --- the lower bound -----------------------------------------------------------------------------


def _family(result: Decomposition, sheet: PanelSheet) -> Document:
    """The motion of all parts with the largest families that are known to fold."""
    densities: dict[Edge, float] = {}
    for part in result.parts:
        densities |= _moved(part)
    letters = dict.fromkeys(result.pattern.folds, "F")
    letters |= {fold: "V" if x > 0 else "M" for fold, x in densities.items()}
    flat = [fold for fold, letter in letters.items() if letter == "F"]
    moving = stars(result.pattern, flat)
    matched = PanelMatch(result.pattern, letters, PROVED, PROVED, (), densities, None, (), (), ())
    motion = []
    for group in connected(sheet.live(flat)):
        answer = PartAnswer(tuple(group), PROVED, PROVED, densities=densities)
        motion.append(motion_evidence(matched, moving, answer))
    return {"letters": "".join(letters.values()), "motion": motion}


def _moved(part: Part) -> Mapping[Edge, float]:
    """The densities of a motion of a part, nearly: of modes that move no common vertex, or of a
    component that was found, whichever has the larger dimension."""
    apart: set[int] = set()
    total: dict[Edge, float] = {}
    number = 0
    for mode in sorted(part.modes, key=lambda mode: len(mode.active)):
        if mode.extends.verdict is PROVED and not apart.intersection(mode.active):
            apart.update(mode.active)
            total |= {fold: 1.0 if x == "V" else -1.0 for fold, x in mode.assignment.items()}
            number += 1
    folding = [one for one in part.found if one.folds and one.dimension > number]
    if folding:
        best = max(folding, key=lambda one: one.dimension)
        near = {fold: float(x.mid()) for fold, x in best.motion.items()}
        largest = max(map(abs, near.values()))
        return {fold: x / largest for fold, x in near.items() if abs(x) > _TINY * largest}
    return total


# --- the upper bound -----------------------------------------------------------------------------


def _apart(moving: Mapping[int, Star]) -> list[int]:
    """Vertices without a common fold whose local motions seem to combine freely."""
    folds = sorted({fold for star in moving.values() for fold in star.folds})
    place = {fold: k for k, fold in enumerate(folds)}
    matrix = np.zeros((2 * len(moving), len(folds)))
    for n, star in enumerate(moving.values()):
        for fold, direction in zip(star.folds, star.directions, strict=True):
            matrix[2 * n : 2 * n + 2, place[fold]] = [float(x) for x in direction]
    if not folds:
        return []
    matrix /= np.abs(matrix).max()
    return combining(moving, folds, null_space(matrix, rcond=_TINY))


def _modulus(sheet: PanelSheet) -> Document:
    """A prime for which all radicands of the field are squares, and residues of their roots."""
    prime = fmpz(_MODULUS)
    for _ in range(_MOST_PRIMES):
        prime += 1
        while not (prime % 4 == 3 and prime.is_probable_prime()):
            prime += 1
        roots = _roots(sheet, int(prime))
        if roots is not None:
            return {"modulus": int(prime), "roots": roots}
    raise NotApplicableError("no prime was found for which the field of the sheet has residues")


def _roots(sheet: PanelSheet, prime: int) -> list[int] | None:
    """Square roots of the residues of all radicands modulo a prime, or None."""
    roots: list[int] = []
    products = [1]
    for parts in sheet.tower.radicands:
        square: Any = 0
        for c, product in zip(parts, products, strict=True):
            if c.denominator % prime == 0:
                return None
            square += c.numerator * pow(c.denominator, -1, prime) * product
        root = pow(square % prime, (prime + 1) // 4, prime)
        if (root * root - square) % prime:
            return None
        roots.append(root)
        products += [product * root % prime for product in products]
    return roots
