"""`check` verifies certificates of every kind, from files and from results."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import exactfold
from exactfold import PROVED, REFUTED, checker
from exactfold.branches import branch_certificate
from exactfold.errors import CertificateFormatError, UnreadableFileError

FIXTURES = Path(__file__).parents[2] / "fixtures" / "certificates"
ONE_OF_EACH = (
    "assignments-cross.json",
    "branch-random.json",
    "compact-convex.txt",
    "letters-bowl.json",
    "listing-cross.json",
    "loops-one-vertex.txt",
    "panelmotion-rates.json",
    "panels-bent.json",
    "pieces-triangle.json",
    "starting-flat.json",
)


@pytest.mark.parametrize("name", ONE_OF_EACH)
def test_certificates_of_every_kind_hold(name):
    path = FIXTURES / name
    found = exactfold.check(path, workers=1)
    assert found.status is PROVED
    assert found
    assert found.text.startswith("VALID")
    assert found.claims == checker.verify(path)


def test_a_claim_that_is_not_supported_is_refuted(tmp_path):
    evidence = branch_certificate(exactfold.branch("two-vertex", "+-"))
    forged = evidence | {"claims": evidence["claims"] | {"vertex_signs": [1, 1]}}
    path = tmp_path / "forged.json"
    path.write_text(json.dumps(forged))
    for given in (forged, path, str(path)):
        found = exactfold.check(given)
        assert found.status is REFUTED
        assert not found
        assert found.claims == {}
        assert found.reason in found.text


def test_what_is_no_certificate_is_an_error(tmp_path):
    path = tmp_path / "count.json"
    path.write_text(json.dumps(exactfold.count("two-vertex").to_dict()))
    with pytest.raises(CertificateFormatError, match=f"^{path}: "):
        exactfold.check(path)
    with pytest.raises(CertificateFormatError, match=r"^the certificate: "):
        exactfold.check(exactfold.count("two-vertex").to_dict())
    with pytest.raises(UnreadableFileError, match=r"cannot read none\.json"):
        exactfold.check("none.json")
