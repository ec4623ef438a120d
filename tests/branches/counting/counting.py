"""What counts of all kinds of patterns are compared with."""

from collections import Counter
from itertools import product

from exactfold import PROVED


def counts(result):
    return result.distinct, result.with_multiplicity, result.real, result.nonreal


def all_pairs(size):
    """Every vertex-sign vector up to reversal, twice."""
    vectors = ["".join(signs) for signs in product("+-", repeat=size) if signs[0] == "+"]
    return Counter(dict.fromkeys(vectors, 2))


def check_generic(pattern, result):
    """2^(Vi - Vt) simple branches, two for each pair of opposite sign vectors."""
    free = pattern.Vi - pattern.Vt
    assert result.status is PROVED
    assert result.true_branches is PROVED
    assert counts(result) == (1 << free, 1 << pattern.Vi, 1 << free, 0)
    assert len(result.branches) == 1 << free
    loose = [pattern.interior.index(v) for v in pattern.foldable_vertices]
    seen = Counter()
    for branch in result.branches:
        assert branch.multiplicity == 1 << pattern.Vt
        assert all(branch.vertex_signs[v] == 0 for v in pattern.rigid_vertices)
        signs = "".join(branch.sign_text[k] for k in loose)
        assert "0" not in signs
        seen[signs if signs[:1] == "+" else signs.translate(str.maketrans("+-", "-+"))] += 1
    assert seen == all_pairs(free) if free else seen == Counter({"": 1})


def summary(result):
    return [(b.sign_text, b.assignment_text, b.multiplicity) for b in result.branches]
