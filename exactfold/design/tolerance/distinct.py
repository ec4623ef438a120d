"""Whether zeros in boxes are proved to be different points of projective space."""

from __future__ import annotations

import numpy as np

from exactfold._support.arrays import BoolArray
from exactfold.design.tolerance.parts import TrackedPart
from exactfold.design.tolerance.radius import Radii
from exactfold.solve.certify.float_balls import Mids

_ROOM = 1e-12
_WIDE = 0.5


def all_distinct(part: TrackedPart, radii: Radii) -> bool:
    """Whether all zeros of a part are different; of two conjugate ones, one is given.

    Zero i is scaled so that c_i x = 1 with the conjugate c_i of its unit vector. If x_i and x_j are
    multiples of each other, x_j = (c_i x_j) x_i. Real zeros whose densities have different signs
    are different, so that only those with the same letters are compared.
    """
    zeros, errors = part.zeros, radii.errors
    if not errors.max() * zeros.shape[1] < _WIDE:  # also where nothing is proved
        return False
    groups: dict[bytes, list[int]] = {}
    odd = [k for k, name in enumerate(part.names) if not name]
    for k, densities in enumerate(radii.densities.real):
        if part.names[k]:
            signs = np.sign(densities)
            groups.setdefault((signs * signs[0]).astype(np.int8).tobytes(), []).append(k)
    for group in groups.values():
        for place, k in enumerate(group):
            others = group[place + 1 :]
            if not _apart(zeros, errors, k, zeros[others], errors[others]).all():
                return False
    for place, k in enumerate(odd):
        real = [j for j, name in enumerate(part.names) if name]
        later = odd[place + 1 :]
        for others in (real, later):
            if not _apart(zeros, errors, k, zeros[others], errors[others]).all():
                return False
        mirrored = [k, *later]
        if not _apart(zeros, errors, k, zeros[mirrored].conj(), errors[mirrored]).all():
            return False
    return True


def _apart(zeros: Mids, errors: Mids, k: int, others: Mids, off: Mids) -> BoolArray:
    """Which of the other zeros are proved to be no multiples of zero k."""
    own = zeros[k]
    shares = others @ own.conj()
    rest = np.abs(others - shares[:, None] * own)
    size = own.size
    # |x| <= 1 entry by entry, so that each of the n products is off by no more than this.
    bound = off + (size * off + _ROOM * size) * (1 + errors[k]) + (np.abs(shares) + 1) * errors[k]
    return np.asarray((rest > (bound * 1.01 + _ROOM)[:, None]).any(axis=1))
