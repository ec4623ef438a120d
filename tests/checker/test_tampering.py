"""A changed certificate is rejected, or what it still says is true."""

import json
import re
from collections import Counter

import pytest
from certificates import (
    KINDS,
    SHEETS,
    document,
    leaf_changes,
    nodes,
    replaced,
    structure_changes,
    type_changes,
)
from old_listing import old_listing

from exactfold import PROVED, checker
from exactfold.branches import count_branches
from exactfold.errors import InputError
from exactfold.pattern.crease_pattern import CreasePattern

names = pytest.mark.parametrize("name", SHEETS)


def verdict(changed):
    """The verified claims, or None if the checker rejects; any other exception is a failure."""
    try:
        return checker.check(checker.load(json.dumps(changed)))
    except (checker.CertificateError, checker.FormatError):
        return None


def statement(claims):
    """What claims say, regardless of the order in which branches are listed."""
    rest = {key: (type(x), x) for key, x in claims.items() if key != "branches"}
    return rest, Counter(json.dumps(branch, sort_keys=True) for branch in claims["branches"])


def check_harmless(name, changed, truth):
    """Rejected, or the same statement of the same pattern; whether it is rejected."""
    claims = verdict(changed)
    if claims is not None:
        assert statement(claims) == truth
        assert claims["sha256"] == SHEETS[name].sha256
    return claims is None


def tampered(name, parts, changes):
    original = document(name)
    for part in parts:
        for path, value in nodes(original[part], (part,)):
            for new in changes(value):
                yield path, replaced(original, path, new)


@names
def test_untouched_is_valid(name):
    original = document(name)
    assert original["evidence"]["kind"] == KINDS[name]
    assert verdict(original) == original["claims"]


@names
def test_changed_claim_is_rejected(name):
    count = 0
    for path, changed in tampered(name, ["claims"], leaf_changes):
        assert verdict(changed) is None, path
        count += 1
    assert count > 20


@names
def test_changed_pattern_is_rejected(name):
    """The digest in the claims names the pattern, so no digit of it may change (0 to -0 may)."""
    for path, changed in tampered(name, ["pattern"], leaf_changes):
        assert verdict(changed) is None or resealed(changed)[0] == SHEETS[name], path


@names
def test_changed_evidence_is_rejected_or_proves_the_same(name):
    truth = statement(document(name)["claims"])
    outcomes = Counter()
    for _, changed in tampered(name, ["evidence"], leaf_changes):
        outcomes[check_harmless(name, changed, truth)] += 1
    assert outcomes[True] > 0 or KINDS[name] == "single vertex"


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(x, marks=getattr(pytest.mark, "slow" if x == "flat vertex" else "survey"))
        for x in SHEETS
    ],
)
def test_values_of_other_types_are_rejected_or_harmless(name):
    truth = statement(document(name)["claims"])
    for _, changed in tampered(name, ["pattern", "claims", "evidence"], type_changes):
        check_harmless(name, changed, truth)


@names
def test_structure_changes_are_rejected_or_harmless(name):
    truth = statement(document(name)["claims"])
    for _, changed in tampered(name, ["pattern", "claims", "evidence"], structure_changes):
        check_harmless(name, changed, truth)


@names
def test_top_level_changes_are_rejected(name):
    original = document(name)
    for changed in structure_changes(original):
        assert verdict(changed) is None
    for key in ("format", "version", "pattern", "claims", "evidence"):
        for new in type_changes(original[key]):
            if new != original[key] or type(new) is not type(original[key]):
                assert verdict({**original, key: new}) is None


@names
def test_provenance_may_change_freely(name):
    original = document(name)
    for new in (None, {}, [], "anyone", {"method": "guess", "settings": {"seed": -1}}):
        assert verdict({**original, "provenance": new}) == original["claims"]


# --- claims and evidence changed together --------------------------------------------------------


def roots_and_branches(name):
    original = document(name)
    return original, original["claims"]["branches"], original["evidence"].get("roots", [])


@pytest.mark.parametrize("name", [n for n, kind in KINDS.items() if kind != "rigid"])
def test_reordered_roots_need_reordered_branches(name):
    original, branches, roots = roots_and_branches(name)
    if len(branches) < 2:
        pytest.skip("one branch has one order")
    both = replaced(original, ("claims", "branches"), branches[::-1])
    both = replaced(both, ("evidence", "roots"), roots[::-1])
    assert statement(verdict(both)) == statement(original["claims"])
    alone = replaced(original, ("evidence", "roots"), roots[::-1])
    assert verdict(alone) is None


@pytest.mark.parametrize("name", ["one vertex", "two vertices", "reflex", "flat vertex"])
def test_a_dropped_branch_is_missed(name):
    """Even if every count is lowered to match."""
    original, branches, roots = roots_and_branches(name)
    for k in range(len(branches)):
        changed = replaced(original, ("claims", "branches"), branches[:k] + branches[k + 1 :])
        changed = replaced(changed, ("evidence", "roots"), roots[:k] + roots[k + 1 :])
        for key in ("distinct", "real"):
            changed["claims"][key] -= 1
        assert verdict(changed) is None
        changed["claims"]["nonreal"] += 1
        changed["claims"]["distinct"] += 1
        assert verdict(changed) is None


@pytest.mark.parametrize("name", ["one vertex", "two vertices", "reflex", "flat vertex"])
def test_a_doubled_branch_is_noticed(name):
    original, branches, roots = roots_and_branches(name)
    for k in range(len(branches)):
        for keep in (len(branches), len(branches) + 1):
            changed = replaced(original, ("claims", "branches"), ([branches[k], *branches])[:keep])
            changed = replaced(changed, ("evidence", "roots"), ([roots[k], *roots])[:keep])
            changed["claims"]["distinct"] = changed["claims"]["real"] = keep
            if k == len(branches) - 1 and keep == len(branches):
                # The last branch moved to the front: nothing is doubled.
                assert statement(verdict(changed)) == statement(original["claims"])
            else:
                assert verdict(changed) is None


def test_a_root_nudged_by_less_than_its_radius_is_doubled_and_noticed():
    """Overlapping boxes around one root must not pass as two roots."""
    original, _, roots = roots_and_branches("two vertices")
    for k in range(len(roots)):
        for nudge in (1, int(roots[k]["radius"]) // 2, 2 * int(roots[k]["radius"])):
            center = [str(int(m) + nudge) for m in roots[k]["center"]]
            twin = {**roots[k], "center": center}
            changed = [*roots[:k], twin, *roots[k + 1 :]]
            changed[(k + 1) % len(roots)] = roots[k]
            assert verdict(replaced(original, ("evidence", "roots"), changed)) is None


def test_evidence_of_one_sheet_does_not_prove_another():
    for name in SHEETS:
        for other in SHEETS:
            if other != name:
                mixed = {**document(name), "evidence": document(other)["evidence"]}
                claims = verdict(mixed)
                assert claims is None or statement(claims) == statement(document(name)["claims"])


def test_kind_of_evidence_cannot_be_exchanged():
    for name, kind in KINDS.items():
        for other in {*KINDS.values(), "unknown", ""} - {kind}:
            assert verdict(replaced(document(name), ("evidence", "kind"), other)) is None


def test_flat_vertices_cannot_be_invented_or_left_out():
    original = document("flat vertex")
    classes = original["evidence"]["classes"]
    assert sorted(len(entry["flat"]) for entry in classes)[-1] == 1
    interior = [4, 5]
    for k, entry in enumerate(classes):
        for flat in ([], *([v] for v in interior), interior, [4, 4], [0], [9], ["4"], None, {}):
            if flat != entry["flat"]:
                path = ("evidence", "classes", k, "flat")
                assert verdict(replaced(original, path, flat)) is None


# --- changed patterns with the digest brought into line -----------------------------------------


def resealed(changed):
    """The changed certificate with the digest of its own pattern, None if it has no valid one."""
    try:
        pattern = CreasePattern(changed["pattern"]["vertices"], changed["pattern"]["triangles"])
    except (InputError, ZeroDivisionError):
        return None, changed
    return pattern, replaced(changed, ("claims", "sha256"), pattern.sha256)


@pytest.mark.parametrize("name", ["one vertex", "chord", "reflex", "rigid", "five folds"])
def test_resealed_pattern_is_rejected_or_counted_the_same(name):
    accepted = 0
    for path, changed in tampered(name, ["pattern"], leaf_changes):
        pattern, changed = resealed(changed)
        claims = verdict(changed)
        if claims is None or pattern == SHEETS[name]:
            continue
        assert pattern is not None, path
        again = count_branches(pattern)
        assert again.status is PROVED
        assert statement(old_listing(again)["claims"]) == statement(claims)
        accepted += 1
    # The evidence for rigidity and for one vertex is robust, and so is that of a reflex boundary,
    # as its chart is in the file; boxes of roots in the chart of the pattern are not.
    assert (accepted > 0) == (name in ("chord", "reflex", "rigid", "five folds"))


def test_another_rational_of_the_same_value_has_the_same_digest():
    original = document("two vertices")
    for k, pair in enumerate(original["pattern"]["vertices"]):
        for axis, text in enumerate(pair):
            p, _, q = text.partition("/")
            same = f"{3 * int(p)}/{3 * int(q or 1)}"
            changed = replaced(original, ("pattern", "vertices", k, axis), same)
            assert verdict(changed) == original["claims"]


# --- the text of the file ------------------------------------------------------------------------


@names
def test_cut_off_anywhere_is_no_certificate(name):
    text = json.dumps(document(name))
    for end in {*range(0, len(text), max(1, len(text) // 200)), len(text) - 1}:
        with pytest.raises(checker.FormatError):
            checker.load(text[:end])


def test_repeated_keys_are_refused():
    text = json.dumps(document("one vertex"))
    for old, new in (
        ('"distinct": 2', '"distinct": 3, "distinct": 2'),
        ('"kind": "isolated"', '"kind": "rigid", "kind": "isolated"'),
        ('"version": 2', '"version": 2, "version": 2'),
    ):
        assert old in text
        with pytest.raises(checker.FormatError, match="twice"):
            checker.load(text.replace(old, new))


@pytest.mark.parametrize("number", ["1.0", "2e0", "NaN", "Infinity", "-Infinity", "1E400"])
def test_floats_are_refused_everywhere(number):
    text = json.dumps(document("one vertex"))
    for old in ('"distinct": 2', '"version": 2', '"multiplicity": 1', '"bits": 44'):
        assert old in text
        with pytest.raises(checker.FormatError, match="no floats"):
            checker.load(text.replace(old, old.split(":")[0] + ": " + number))


@pytest.mark.parametrize("text", ["", "[]", "1", "null", '"x"', "[" * 10**5, '{"format": 1}'])
def test_not_a_certificate(text):
    with pytest.raises(checker.FormatError):
        checker.load(text)


def test_deep_nesting_inside_a_certificate_is_no_crash():
    original = document("one vertex")
    text = json.dumps(original).replace('"provenance": {', '"provenance": {"a": ' + "[" * 10**5)
    with pytest.raises(checker.FormatError):
        checker.load(text)


def test_integers_too_long_to_print_are_no_crash():
    original = document("rigid vertex")
    text = json.dumps(original)
    for old in ('"distinct": 4', '"version": 2', '"inside": [6', '"multiplicity": 2', "[[0, 1, 4"):
        assert old in text, old
        with pytest.raises(checker.FormatError, match="too long"):
            checker.load(text.replace(old, re.sub(r"\d+$", "9" * 5000, old)))
