"""One suite for every kind of certificate in the checker's table."""

from __future__ import annotations

import copy
import io
import json
import pickle
from functools import cache
from pathlib import Path
from typing import Any, is_typeddict

import pytest
from typed_values import misfits

from exactfold import checker
from exactfold.checker import CertificateError, FormatError
from exactfold.checker.command import DOCUMENTS, IN_LINES, KINDS
from exactfold.checker.core.kinds import DocumentKind, Kind
from exactfold.checker.core.lines import digest, lines

FIXTURES = Path(__file__).parent.parent / "fixtures" / "certificates"
Document = dict[str, Any]


def name_of(kind: Kind[Any]) -> str:
    named = kind.named if isinstance(kind, DocumentKind) else None
    return (named or kind.format).removeprefix("exactfold ").replace(" ", "-")


def head_of(path: Path) -> Document:
    """The object of a file, or of its first line."""
    head: Document = json.loads(path.read_text().partition("\t")[0])
    return head


@cache
def files() -> dict[tuple[str, int], tuple[Path, ...]]:
    """The fixtures by the kind and the version that they say, the smallest first."""
    found: dict[tuple[str, int], tuple[Path, ...]] = {}
    paths = [path for path in FIXTURES.iterdir() if path.suffix in (".json", ".txt")]
    for path in sorted(paths, key=lambda path: path.stat().st_size):
        head = head_of(path)
        format = head["format"].removeprefix("exactfold ").replace(" ", "-")
        name = head.get("kind", format), head["version"]
        found[name] = (*found.get(name, ()), path)
    return found


CASES = [(kind, version) for kind in KINDS for version in kind.versions]
every_version = pytest.mark.parametrize(
    ("kind", "version"), CASES, ids=[f"{name_of(kind)}-{version}" for kind, version in CASES]
)
every_kind = pytest.mark.parametrize("kind", KINDS, ids=map(name_of, KINDS))


def smallest(kind: Kind[Any], version: int) -> Path:
    return files()[name_of(kind), version][0]


def test_each_kind_is_in_the_table_once() -> None:
    names = [name_of(kind) for kind in KINDS]
    assert len(set(names)) == len(names) == len(DOCUMENTS) + len(IN_LINES)
    assert {name for name, _ in files()} == set(names)


@every_version
def test_there_are_fixtures_of_every_version_and_the_kind_reads_them(
    kind: Kind[Any], version: int
) -> None:
    for path in files()[name_of(kind), version]:
        head = head_of(path)
        assert kind.read(head) == head


@every_kind
def test_objects_of_other_kinds_are_not_read(kind: Kind[Any]) -> None:
    for (name, _), (path, *_) in files().items():
        if name != name_of(kind):
            with pytest.raises(FormatError):
                kind.read(head_of(path))


@every_version
def test_what_is_no_object_of_the_kind_is_not_read(kind: Kind[Any], version: int) -> None:
    head = head_of(smallest(kind, version))
    unknown = (0, max(kind.versions) + 1, True, str(version), None, [version])
    for wrong in unknown:
        with pytest.raises(FormatError, match=r"version .* is not known to this checker"):
            kind.read({**head, "version": wrong})
    for wrong in (None, "exactfold", [kind.format]):
        with pytest.raises(FormatError, match=f'no "format": "{kind.format}"'):
            kind.read({**head, "format": wrong})
    for value in (None, [], [head], kind.format):
        with pytest.raises(FormatError, match=f'no "format": "{kind.format}"'):
            kind.read(value)
    with pytest.raises(FormatError, match="expected an object with the keys"):
        kind.read({**head, "more": 1})
    for name in head.keys() - {"format", "version"}:
        with pytest.raises(FormatError):
            kind.read({key: value for key, value in head.items() if key != name})


@every_version
def test_verified_claims_know_their_kind(kind: Kind[Any], version: int) -> None:
    verified = checker.verify(smallest(kind, version))
    assert verified.kind is kind
    assert dict(verified) == verified.claims == verified
    line = checker.summary(verified)
    assert line == kind.summary(verified.claims)
    assert line.startswith("VALID: ")
    assert line.endswith(f"sha256 {verified['sha256']}")
    assert line.isprintable()
    assert len(verified["sha256"]) == 64
    assert repr(verified).startswith(f"Verified({kind.format!r}, {{")


@every_version
def test_verified_claims_are_of_the_type_of_their_kind(kind: Kind[Any], version: int) -> None:
    assert is_typeddict(kind.claims)
    assert list(misfits(checker.verify(smallest(kind, version)).claims, kind.claims)) == []


@every_version
def test_verified_claims_pickle_and_copy(kind: Kind[Any], version: int) -> None:
    verified = checker.verify(smallest(kind, version))
    for other in (pickle.loads(pickle.dumps(verified)), copy.deepcopy(verified)):
        assert other == verified
        assert checker.summary(other) == checker.summary(verified)


@every_version
def test_no_claim_is_passed_over(kind: Kind[Any], version: int) -> None:
    """A claim that is left out, added, or replaced by something else is refused."""
    path = smallest(kind, version)
    claims = head_of(path)["claims"] if path.suffix == ".json" else bodies(path)[-1]["claims"]
    judged(path, claims)
    for name in claims:
        with pytest.raises(CertificateError):
            judged(path, {key: value for key, value in claims.items() if key != name})
        with pytest.raises(CertificateError):
            judged(path, {**claims, name: {"a": [claims[name]]}})
    for wrong in ({**claims, "more": 1}, [claims], None):
        with pytest.raises(CertificateError):
            judged(path, wrong)


def bodies(path: Path) -> list[Document]:
    return [json.loads(text) for text in lines(io.BytesIO(path.read_bytes()))]


def judged(path: Path, claims: Any) -> None:
    """The certificate with other claims, as the checker reads it."""
    if path.suffix == ".json":
        checker.check(checker.load(json.dumps({**head_of(path), "claims": claims})))
        return
    parts, last, content = bodies(path), "", ""
    for part in (*parts[:-1], {"claims": claims}):
        last = digest(last, text := json.dumps(part))
        content += f"{text}\t{last}\n"
    stream = io.BytesIO(content.encode())
    kind = next(kind for kind in IN_LINES if kind.format == parts[0]["format"])
    kind.check(lines(stream), 1, kind.engine)


# --- types ---------------------------------------------------------------------------------------


def test_what_does_not_fit_is_found() -> None:
    from exactfold.checker.branches.branch import VerifiedBranch

    good = {"gauge": "rim", "vertex_signs": [1], "assignment": "M", "squared_distance": "0"}
    good |= {"interior": 1, "sha256": ""}
    assert list(misfits(good, VerifiedBranch)) == []
    assert list(misfits({**good, "curvature": []}, VerifiedBranch)) == []
    for wrong in (
        {**good, "interior": True},
        {**good, "vertex_signs": [None]},
        {**good, "more": 1},
        {**good, "curvature": {}},
        {key: value for key, value in good.items() if key != "gauge"},
        [],
    ):
        assert len(list(misfits(wrong, VerifiedBranch))) == 1
    assert list(misfits({"1": 1}, dict[str, int] | None)) == []
    assert list(misfits({"1": "1"}, dict[str, int] | None)) != []
