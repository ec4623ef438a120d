"""The program that is extracted from the formal proof, compared with the checker in Python."""

import json
import random
import re
import shutil
import subprocess
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from compact_files import Lines, bodies, chained, chained_texts, listed_exactly, put, raw
from compare_checkers import compare, mutate
from verifying import run, valid

from exactfold.branches import branch_certificate, find_branch
from exactfold.branches.counting.stream import stream_branches
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.random_squares import sample_random_square
from exactfold.rigidity.curvature import curvature_form

ROOT = Path(__file__).parent.parent.parent
SOURCES = ROOT / "proofs" / "formal" / "verify"
CERTIFICATES = ROOT / "tests" / "fixtures" / "certificates"
COMPACT = sorted(CERTIFICATES.glob("compact-*.txt"))
BRANCHES = sorted(CERTIFICATES.glob("branch-*.json"))
LISTINGS = sorted(
    path
    for kind in ("listing", "algebraic", "rigid", "single-vertex")
    for path in CERTIFICATES.glob(f"{kind}-*.json")
)
NAMED = {
    'version 1 of "exactfold branch" are verified here': {
        "branch-deficits",
        "branch-deficits-triangles",
        "branch-merged",
    },
    'the evidence is "rigid", not': {"compact-roots-rigid", "rigid-nested", "rigid-triangle"},
    'the evidence is "single vertex", not': {
        "compact-roots-single-vertex",
        *(f"single-vertex-{name}" for name in ("nine-folds", "triangle", "waterbomb")),
    },
}
"""Why the program does not verify certificates that the checker in Python does."""
CONTINUED = {
    *("compact-roots-groebner", "listing-cross", "listing-huge-numbers", "listing-isolated"),
    *("listing-one-vertex", "listing-one-vertex-groebner", "listing-open-folds"),
    *("listing-straight-path", "listing-straight-side", "listing-two-vertices"),
    "listing-two-vertices-groebner",
}
"""Listings of convex sheets with nothing that stays flat, whose branches continue."""
MOVING = {"convex", "low-rim", "random", "rim"}
"""Certificates of one branch of a convex sheet on which no vertex is flat."""
CONVEX = CERTIFICATES / "compact-convex.txt"
TRIANGLES = CERTIFICATES / "compact-triangles.txt"
RANDOM = CERTIFICATES / "branch-random.json"
NOTCHED = CreasePattern(
    [(0, 0), (96, 3), (20, 90), (50, 54), (52, 39), (65, 18), (37, 18), (33, 69)],
    [
        *((0, 1, 6), (1, 2, 3), (1, 5, 6), (4, 6, 5), (1, 3, 5)),
        *((3, 4, 5), (2, 7, 3), (0, 6, 7), (4, 7, 6), (3, 7, 4)),
    ],
)
"""A sheet with four corners, of which vertex 7 is reflex, and four vertices inside."""


def test_the_page_says_how_long_what_has_to_be_believed_is() -> None:
    page = (ROOT / "docs" / "formal.md").read_text(encoding="utf-8")
    said = re.search(r"together some\s+([\d,]+)\s+lines", page)
    assert said is not None
    names = {path.name for path in SOURCES.glob("*.ml")}
    names -= {"proposing.ml", "spaces.ml", "verified.ml"}
    names.add("Extract.v")
    named = page[: said.start()].rpartition("\n- ")[2]
    assert set(re.findall(r"`(\w+\.(?:ml|v))`", named)) == names
    lines = sum(len((SOURCES / n).read_text(encoding="utf-8").splitlines()) for n in names)
    assert abs(lines - int(said[1].replace(",", ""))) < 20


@pytest.mark.slow
def test_both_checkers_agree_on_every_fixture(verifier: Path) -> None:
    differ: dict[str, set[str]] = {why: set() for why in NAMED}
    for path in (*COMPACT, *BRANCHES, *LISTINGS):
        code, text = run(verifier, path)
        claims = valid(path)
        assert claims is not None, path.name
        if code == 0:
            assert claims["sha256"] in text
            assert "by theorem disk_moves" in text
            if path not in BRANCHES:
                assert f"exactly {claims['distinct']} branch" in text
                plain = "By theorem all_verified" in text or path.stem in CONTINUED
                found = re.search(r"by theorem (all|listed)_continue", text)
                assert (found is not None) == plain
                said = "not verified here: that every branch continues" in text
                assert said == (claims["true_branches"] == "proved" and not plain)
            else:
                plain = path.name in {f"branch-{name}.json" for name in MOVING}
                assert ("one_continues" in text or "exact_continues" in text) == plain
                assert ("not verified here: that it continues" in text) != plain
        else:
            (why,) = [why for why in NAMED if why in text]
            assert code == 3
            differ[why].add(path.stem)
    assert differ == NAMED


def compact_forgeries() -> dict[str, Callable[[Lines], object]]:
    """Changes of `compact-convex`, whose digests are made anew, with what is said of each."""

    def letters(lines: Lines) -> None:
        folds = raw(lines[1], "folds")
        folds[0] ^= 1
        put(lines[1], "folds", folds)

    def swapped(lines: Lines) -> None:
        centers, size = raw(lines[1], "centers"), 4 * lines[1]["width"]
        put(lines[1], "centers", centers[size : 2 * size] + centers[:size] + centers[2 * size :])

    def face(lines: Lines) -> None:
        lines[0]["pattern"]["triangles"][0].reverse()

    def moved(lines: Lines) -> None:
        lines[0]["pattern"]["vertices"][-1][0] = "1/3"

    def padding(lines: Lines) -> None:
        folds = raw(lines[1], "folds")
        folds[1] |= 128
        put(lines[1], "folds", folds)

    def unlisted(lines: Lines) -> None:
        radii = raw(lines[1], "radii")
        radii[1] = 255
        put(lines[1], "radii", radii)

    def flat(lines: Lines) -> None:
        listed_exactly(lines)
        letters = lines[1]["exact"][0]["assignment"]
        listed_exactly(lines, assignment="F" + letters[1:])

    def claim(**changes: object) -> Callable[[Lines], object]:
        return lambda lines: lines[-1]["claims"].update(changes)

    return {
        "NOT VERIFIED  root 0 did not pass the test": letters,
        "NOT VERIFIED  root 1 did not pass the test": swapped,
        "does not run counter-clockwise": face,
        'the claim "sha256" is': moved,
        'the claim "sha256" is 0000': claim(sha256="0" * 64),
        'the claim "distinct" is 15': claim(distinct=15),
        'the claim "real" is 15': claim(real=15),
        'the claim "with_multiplicity" is 32': claim(with_multiplicity=32),
        'the claim "nonreal" is 1': claim(nonreal=1),
        'the claim "interior" is 5': claim(interior=5),
        'the claim "boundary" is 5': claim(boundary=5),
        'the claim "folds" is 12': claim(folds=12),
        'the claim "degrees_of_freedom" is 2': claim(degrees_of_freedom=2),
        'the claim "true_branches" is not': claim(true_branches="refuted"),
        "distinct is no number": claim(distinct="16"),
        "has another length": lambda lines: put(lines[1], "radii", raw(lines[1], "radii")[1:]),
        "the number of blocks is wrong": lambda lines: lines.pop(1),
        "UNFINISHED": lambda lines: lines.pop(),
        "block 0 has open roots": lambda lines: lines[1]["open"].append([0, "hard"]),
        "block 0 is expected": lambda lines: lines[1].update(block=1),
        'the key "more" is not known': lambda lines: lines[1].update(more=1),
        "folds is not base 64": lambda lines: lines[1].update(folds=lines[1]["folds"][:-3] + "=AA"),
        "width is out of range": lambda lines: lines[1].update(width=0),
        "bits is out of range": lambda lines: lines[1].update(bits=53),
        "a bit of no fold is set": padding,
        "root 1 of block 0 is given twice or not at all": unlisted,
        "no fold with the letter M or V": lambda lines: listed_exactly(lines, assignment="U" * 13),
        "has another number of letters": lambda lines: listed_exactly(lines, assignment="M"),
        "has the letter F and is not flat": flat,
        "radius is not positive": lambda lines: listed_exactly(lines, radius="-1"),
        "a coordinate is no rational number": lambda lines: lines[0]["pattern"]["vertices"][
            0
        ].__setitem__(0, 0),
        "has a fold with the letter X": lambda lines: listed_exactly(lines, assignment="X" * 13),
        "has another number of heights": lambda lines: listed_exactly(lines, center=["1"]),
        "a face has a vertex that is not there": lambda lines: lines[0]["pattern"]["triangles"][
            0
        ].__setitem__(0, 99),
    }


@pytest.mark.slow
def test_forged_certificates_of_all_branches_are_refused(verifier: Path, tmp_path: Path) -> None:
    assert run(verifier, CONVEX)[0] == 0
    for said, change in compact_forgeries().items():
        lines = bodies(CONVEX.read_bytes())
        change(lines)
        path = tmp_path / "forged.txt"
        path.write_bytes(chained(lines))
        code, text = run(verifier, path)
        assert code in (1, 3), said
        assert said in text, (said, text)
        assert "VERIFIED  exactly" not in text
        assert (valid(path) is None) == ("letter M or V" not in said), said
    altered = tmp_path / "altered.txt"
    altered.write_bytes(CONVEX.read_bytes().replace(b'"distinct":16', b'"distinct":17'))
    code, text = run(verifier, altered)
    assert (code, "line 3 is cut off or was altered" in text) == (1, True)


@pytest.fixture(scope="module")
def notch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The certificate of all branches of `NOTCHED`."""
    path = tmp_path_factory.mktemp("notch") / "notch.txt"
    stream_branches(NOTCHED, path)
    return path


@pytest.mark.slow
def test_a_sheet_with_a_reflex_corner(verifier: Path, notch: Path) -> None:
    assert valid(notch) is not None
    code, text = run(verifier, notch)
    assert code == 0
    assert "4 inside and 4 on the boundary, 10 triangles, 13 folds" in text
    assert "exactly 16 branches" in text
    assert "theorem all_notched_verified" in text
    assert "the side on which vertex 7 pops up" in text
    assert "The chart of the file names this side, by theorem chart_verified" in text


def notch_forgeries() -> list[tuple[str, Callable[[Lines], object]]]:
    """Changes of the certificate of `NOTCHED` that are refused, with what is said of each."""

    def chart(**weights: str | None) -> Callable[[Lines], object]:
        def change(lines: Lines) -> None:
            new = lines[0]["evidence"]["chart"] | {k[1:]: w for k, w in weights.items()}
            lines[0]["evidence"]["chart"] = {k: w for k, w in new.items() if w is not None}

        return change

    def other_side(lines: Lines) -> None:
        chart = lines[0]["evidence"]["chart"]
        for v, weight in chart.items():
            chart[v] = weight[1:] if weight[0] == "-" else "-" + weight

    def letters(lines: Lines) -> None:
        folds = raw(lines[1], "folds")
        folds[2 * 5] ^= 1
        put(lines[1], "folds", folds)

    def no_chart(lines: Lines) -> None:
        lines[0]["evidence"]["chart"] = None

    def pulled(lines: Lines) -> None:
        """K(t, .) of heights t that are on the right side, and have a negative curvature."""
        form = curvature_form(NOTCHED.with_notch_closed(), 7)
        weights = form.integer_functional({v: Fraction(-(v == 4)) for v in form.labels})
        chart = lines[0]["evidence"]["chart"]
        assert chart["4"][0] == "-"  # so that K(mountain, t) > 0
        assert weights[4] > 0  # it is -K(t), times a positive number
        lines[0]["evidence"]["chart"] = {v: str(weights[int(v)]) for v in chart}

    side = "NOT VERIFIED  the chart does not name the side on which vertex 7 pops up"
    return [
        ("the chart is not that of the closed notch", no_chart),
        ('the key "1" is not known', chart(v1="1")),
        ("the chart does not fix the height of the reflex corner", chart(v7=None)),
        ("a weight of the chart is no rational number", chart(v7="1/0")),
        (side, chart(v3=None, v4=None, v6=None)),
        (side, chart(v5="1/1000000")),
        (side, other_side),
        (side, pulled),
        ("NOT VERIFIED  root 5 did not pass the test", letters),
        ('the claim "distinct" is 32', lambda lines: lines[-1]["claims"].update(distinct=32)),
        ('the claim "interior" is 5', lambda lines: lines[-1]["claims"].update(interior=5)),
        ('the claim "boundary" is 3', lambda lines: lines[-1]["claims"].update(boundary=3)),
    ]


@pytest.mark.slow
def test_forged_certificates_with_a_reflex_corner_are_refused(
    verifier: Path, notch: Path, tmp_path: Path
) -> None:
    path = tmp_path / "forged.txt"
    for said, change in notch_forgeries():
        lines = bodies(notch.read_bytes())
        change(lines)
        path.write_bytes(chained(lines))
        code, text = run(verifier, path)
        assert code in (1, 3), said
        assert said in text, (said, text)
        assert valid(path) is None, said
    lines = bodies(notch.read_bytes())
    chart = lines[0]["evidence"]["chart"]
    twice = json.dumps(chart)[:-1] + ', "7": "1"}'
    text = json.dumps(lines[0]).replace(json.dumps(chart), twice)
    path.write_bytes(chained_texts([text, *map(json.dumps, lines[1:])]))
    code, text = run(verifier, path)
    assert (code, '"7" is missing, or given twice' in text) == (3, True)


@pytest.mark.slow
def test_one_branch_with_a_reflex_corner(verifier: Path, tmp_path: Path) -> None:
    path = tmp_path / "branch.json"
    given = branch_certificate(find_branch(NOTCHED, "+--+"))

    def checked(changed: dict[str, Any]) -> tuple[int, str]:
        path.write_text(json.dumps(changed), encoding="utf-8")
        assert (valid(path) is None) == (changed is not given)
        return run(verifier, path)

    code, text = checked(given)
    assert (code, "theorem one_notched_verified" in text) == (0, True)
    assert "exactly one branch lies" in text
    claims, evidence = given["claims"], given["evidence"]
    code, text = checked(negated(given))
    assert (code, "the branch did not pass the test" in text) == (1, True)
    lifted = ["1", *evidence["heights"][1:]]
    code, text = checked(given | {"evidence": evidence | {"heights": lifted}})
    assert (code, "are not all at height 0" in text) == (1, True)
    code, text = checked(given | {"claims": claims | {"gauge": "rim"}})
    assert (code, "needs a convex boundary" in text) == (1, True)
    letters = claims["assignment"]
    other = letters[:-1] + {"M": "V", "V": "M"}[letters[-1]]
    code, text = checked(given | {"claims": claims | {"assignment": other}})
    assert (code, "the branch did not pass the test" in text) == (1, True)
    code, text = checked(given | {"claims": claims | {"vertex_signs": [1, 1, -1, 1]}})
    assert (code, "the branch did not pass the test" in text) == (1, True)


def triangle_forgeries() -> dict[str, Callable[[Lines], object]]:
    """Changes of `compact-triangles` that are refused, with what is said of each."""

    def triangle(key: str, change: Callable[[list[int]], object]) -> Callable[[Lines], object]:
        return lambda lines: change(lines[0]["evidence"]["triangles"][0][key])

    def letters(lines: Lines) -> None:
        folds = raw(lines[1], "folds")
        folds[2 * 3] ^= 2
        put(lines[1], "folds", folds)

    return {
        "a triangle has not three corners": triangle("corners", lambda c: c.pop()),
        "a vertex of a triangle is out of range": triangle("inside", lambda v: v.append(10)),
        "NOT VERIFIED  the triangulated triangles are not those": triangle(
            "inside", lambda v: v.append(v[0])
        ),
        "does not run counter-clockwise": triangle("corners", lambda c: c.reverse()),
        "the number of blocks is wrong": lambda lines: lines[0]["evidence"].update(triangles=[]),
        'the key "more" is not known': lambda lines: lines[0]["evidence"]["triangles"][0].update(
            more=1
        ),
        "a multiplier is no whole number": triangle("multipliers", lambda m: m.append("1/")),
        "NOT VERIFIED  root 3 did not pass the test": letters,
        'the claim "distinct" is 64': lambda lines: lines[-1]["claims"].update(distinct=64),
        'the claim "with_multiplicity" is 8': lambda lines: lines[-1]["claims"].update(
            with_multiplicity=8
        ),
        'the claim "interior" is 3': lambda lines: lines[-1]["claims"].update(interior=3),
        'the claim "folds" is 10': lambda lines: lines[-1]["claims"].update(folds=10),
    }


@pytest.mark.slow
def test_forged_triangulated_triangles_are_refused(verifier: Path, tmp_path: Path) -> None:
    code, text = run(verifier, TRIANGLES)
    assert (code, "theorem all_emptied_verified" in text) == (0, True)
    assert "exactly 8 branches" in text
    assert "The 1 triangle with 3 vertices inside stays flat" in text
    assert "not verified here: the multiplicity" in text
    path = tmp_path / "forged.txt"
    for said, change in triangle_forgeries().items():
        lines = bodies(TRIANGLES.read_bytes())
        change(lines)
        path.write_bytes(chained(lines))
        code, text = run(verifier, path)
        assert code in (1, 3), said
        assert said in text, (said, text)
        assert valid(path) is None, said


@pytest.mark.slow
def test_one_branch_with_triangulated_triangles(verifier: Path, tmp_path: Path) -> None:
    source = CERTIFICATES / "branch-several-triangles.json"
    given = json.loads(source.read_text(encoding="utf-8"))
    claims, evidence = given["claims"], given["evidence"]
    assert run(verifier, source)[0] == 0
    first = next(k for k, h in enumerate(evidence["heights"]) if h is None)
    inside = sorted(v for e in evidence["emptied"] for v in e["inside"])
    faces = given["pattern"]["triangles"]
    interior = range(4, len(given["pattern"]["vertices"]))
    ends = sorted({(min(e), max(e)) for f in faces for e in zip(f, f[1:] + f[:1], strict=True)})
    folds = [e for e in ends if not set(e) <= set(range(4))]
    place = next(k for k, e in enumerate(folds) if first in e)
    assert claims["assignment"][place] == "F"
    assert first in interior

    def exchanged(values: Any, k: int, value: Any) -> Any:
        return [*values[:k], value, *values[k + 1 :]]

    heights, signs = evidence["heights"], claims["vertex_signs"]
    letters = "".join(exchanged(claims["assignment"], place, "M"))
    twice = [e | {"inside": e["inside"] * 2} for e in evidence["emptied"]]
    changes = [
        ("evidence", "heights", exchanged(heights, first, "0"), "triangle and has a height"),
        ("evidence", "heights", exchanged(heights, 0, None), "a height is no whole number"),
        ("evidence", "heights", heights[1:], "the numbers of heights and of vertices differ"),
        ("claims", "vertex_signs", exchanged(signs, first - 4, 1), "and its sign is not 0"),
        ("claims", "vertex_signs", signs[1:], "the numbers of signs and of vertices differ"),
        ("claims", "assignment", letters, "lies inside a triangulated triangle, and is not F"),
        ("evidence", "emptied", twice, "the triangulated triangles are not those of the sheet"),
    ]
    path = tmp_path / "forged.json"
    assert inside[0] == first
    for part, key, value, said in changes:
        path.write_text(json.dumps(given | {part: given[part] | {key: value}}), encoding="utf-8")
        code, text = run(verifier, path)
        assert code in (1, 3), said
        assert said in text, (said, text)
        assert valid(path) is None or value is twice, said


@pytest.mark.slow
def test_what_the_equations_of_many_faces_mean_is_not_verified(
    verifier: Path, tmp_path: Path
) -> None:
    path = tmp_path / "branch.json"
    for inside, verified in ((499, True), (500, False)):
        sheet = sample_random_square(inside, 1, redraw=True).pattern
        assert (len(sheet.triangles) <= 1000) == verified
        found = branch_certificate(find_branch(sheet, up=()))
        path.write_text(json.dumps(found), encoding="utf-8")
        code, text = run(verifier, path)
        assert code == 0
        assert ("by theorem disk_moves" in text) == verified
        assert ("not verified here: that the equations are those of motions" in text) != verified
        assert verified or "one_continues" not in text


@pytest.mark.slow
def test_heights_that_are_exact(verifier: Path, tmp_path: Path) -> None:
    source = CERTIFICATES / "branch-hypar-exact.json"
    given = json.loads(source.read_text(encoding="utf-8"))
    claims, heights = given["claims"], given["evidence"]["heights"]
    code, text = run(verifier, source)
    assert (code, "By theorem exact_verified" in text) == (0, True)
    said = re.findall("not verified here: (.*)", text)
    assert said == ["that it continues to a true motion"]
    letters, signs = claims["assignment"], claims["vertex_signs"]
    assert "F" in letters
    assert 0 in signs
    flat, up = letters.index("F"), next(k for k, s in enumerate(signs) if s)
    place = signs.index(0)
    moved = [*heights[:5], str(int(heights[5]) + 1), *heights[6:]]
    bent = {"M": "V", "V": "M"}
    folded = next(k for k, x in enumerate(letters) if x in bent)
    changes: list[tuple[str, str, Any, str]] = [
        ("claims", "assignment", letters[:flat] + "M" + letters[flat + 1 :], "have its letter"),
        ("claims", "assignment", letters[:folded] + "F" + letters[folded + 1 :], "its letter"),
        (
            *("claims", "assignment"),
            letters[:folded] + bent[letters[folded]] + letters[folded + 1 :],
            "does not have its letter",
        ),
        ("claims", "vertex_signs", [*signs[:up], 0, *signs[up + 1 :]], "the claimed sign"),
        ("claims", "vertex_signs", [*signs[:up], -signs[up], *signs[up + 1 :]], "claimed sign"),
        ("claims", "vertex_signs", [*signs[:place], 1, *signs[place + 1 :]], "the claimed sign"),
        ("claims", "squared_distance", "-1", "which is more than claimed"),
        ("evidence", "heights", moved, "have curvature 0 at vertex"),
    ]
    path = tmp_path / "forged.json"
    for part, key, value, said in changes:
        path.write_text(json.dumps(given | {part: given[part] | {key: value}}), encoding="utf-8")
        code, text = run(verifier, path)
        assert code in (1, 3), said
        assert said in text, (said, text)
        assert valid(path) is None, said


@pytest.mark.slow
@pytest.mark.parametrize(
    ("heights", "sign", "letters"), [((4, 2, 33), 1, "FMFM"), ((20, -34, 561), -1, "VVVM")]
)
def test_exact_heights_with_a_reflex_corner(
    verifier: Path, tmp_path: Path, heights: tuple[int, int, int], sign: int, letters: str
) -> None:
    points = [["0", "6"], ["2", "-2"], ["5", "-3"], ["2", "0"], ["2", "-1"]]
    given: dict[str, Any] = json.loads(RANDOM.read_text(encoding="utf-8"))
    given["pattern"] = {"vertices": points, "triangles": [[k, (k + 1) % 4, 4] for k in range(4)]}
    corner, inner, denominator = heights
    path = tmp_path / "branch.json"

    def checked(
        times: int, signs: list[int], letters: str, distance: str = "0"
    ) -> tuple[int, str, bool]:
        given["claims"] = {
            "gauge": "saddle",
            "vertex_signs": signs,
            "assignment": letters,
            "squared_distance": distance,
        }
        tall = ["0", "0", "0", str(times * corner), str(times * inner)]
        given["evidence"] = {"emptied": [], "heights": tall, "denominator": str(denominator)}
        path.write_text(json.dumps(given), encoding="utf-8")
        return *run(verifier, path), valid(path) is not None

    code, text, accepted = checked(1, [sign], letters)
    assert (code, accepted) == (0, True)
    assert "By theorem exact_notched_verified" in text
    assert "not verified here: the squared distance" in text
    # a multiple of exact heights is exact, too; its distance, which Python verifies, is not 0
    assert checked(2, [sign], letters)[::2] == (0, False)
    for times, signs, other in (
        (1, [-sign], letters),
        (1, [0], letters),
        (1, [sign], letters[1:] + letters[:1]),
        (-1, [-sign], letters.translate(str.maketrans("MV", "VM"))),
    ):
        code, text, accepted = checked(times, signs, other)
        assert (code, accepted) == (1, False), text
        assert "does not have" in text


@pytest.mark.slow
def test_a_reflex_corner_needs_three_others(verifier: Path, tmp_path: Path) -> None:
    given = json.loads((CERTIFICATES / "branch-rim.json").read_text(encoding="utf-8"))
    points = [["0", "0"], ["4", "0"], ["4", "4"], ["2", "2"], ["0", "4"], ["2", "1"]]
    faces = [[0, 1, 5], [1, 2, 5], [2, 3, 5], [3, 4, 5], [4, 0, 5]]
    path = tmp_path / "five.json"
    given["pattern"] = {"vertices": points, "triangles": faces}
    path.write_text(json.dumps(given), encoding="utf-8")
    code, text = run(verifier, path)
    assert (code, "the corner at vertex 3 is reflex, of 5" in text) == (3, True)
    assert valid(path) is None


@pytest.mark.slow
def test_forged_certificates_of_one_branch_are_refused(verifier: Path, tmp_path: Path) -> None:
    given = json.loads(RANDOM.read_text(encoding="utf-8"))
    letters = given["claims"]["assignment"]
    other = letters.translate(str.maketrans("MV", "VM"))
    negated = [str(-int(h)) for h in given["evidence"]["heights"]]
    changes: list[tuple[str, str, Any]] = [
        ("claims", "gauge", "either"),
        ("evidence", "denominator", "-1"),
        ("evidence", "denominator", "one"),
        ("evidence", "denominator", int(given["evidence"]["denominator"])),
        ("claims", "squared_distance", "1/2/3"),
        ("evidence", "heights", negated),
        ("claims", "assignment", other[:1] + letters[1:]),
        ("claims", "assignment", letters[1:]),
        ("claims", "assignment", "F" + letters[1:]),
        ("claims", "vertex_signs", [-s for s in given["claims"]["vertex_signs"]]),
        ("claims", "vertex_signs", given["claims"]["vertex_signs"][1:]),
        ("claims", "vertex_signs", [0, *given["claims"]["vertex_signs"][1:]]),
        ("evidence", "heights", given["evidence"]["heights"][1:]),
        ("evidence", "heights", ["1", *given["evidence"]["heights"][1:]]),
        ("pattern", "triangles", given["pattern"]["triangles"][1:]),
        ("pattern", "triangles", given["pattern"]["triangles"] * 2),
    ]
    for part, key, value in changes:
        forged = given | {part: given[part] | {key: value}}
        path = tmp_path / "forged.json"
        path.write_text(json.dumps(forged), encoding="utf-8")
        code, text = run(verifier, path)
        assert code in (1, 3), (key, text)
        assert "VERIFIED  exactly" not in text
        assert valid(path) is None, key


@pytest.mark.slow
def test_the_squared_distance_is_verified_or_said_not_to_be(verifier: Path, tmp_path: Path) -> None:
    given = json.loads(RANDOM.read_text(encoding="utf-8"))
    claimed = Fraction(given["claims"]["squared_distance"])
    denominator = int(given["evidence"]["denominator"])
    path = tmp_path / "branch.json"

    def verified(distance: Fraction, denominator: int) -> bool:
        """Whether the program verifies the distance, too; it says which it does."""
        claims = given["claims"] | {"squared_distance": str(distance)}
        evidence = given["evidence"] | {"denominator": str(denominator)}
        path.write_text(json.dumps(given | {"claims": claims, "evidence": evidence}))
        code, text = run(verifier, path)
        assert code == 0
        proved = "the squared distance of the file, by theorem distance_verified" in text
        assert ("not verified here: the squared distance" in text) != proved
        assert (valid(path) is not None) == proved
        return proved

    assert verified(claimed, denominator)
    assert not verified(claimed * Fraction(2**20 - 1, 2**20), denominator)
    assert not verified(claimed, denominator // 2)
    assert verified(claimed / 4, denominator * 2)
    assert not verified(-claimed, denominator)


@pytest.mark.slow
def test_the_gauge_saddle_is_one_of_four_vertices_with_a_positive_saddle(
    verifier: Path, tmp_path: Path
) -> None:
    rim = json.loads((CERTIFICATES / "branch-rim.json").read_text(encoding="utf-8"))
    rim["claims"]["gauge"] = "saddle"
    for given in (json.loads(RANDOM.read_text(encoding="utf-8")), apex_first()):
        path = tmp_path / "branch.json"
        path.write_text(json.dumps(given), encoding="utf-8")
        assert run(verifier, path)[0] == 0
        path.write_text(json.dumps(negated(given)), encoding="utf-8")
        code, text = run(verifier, path)
        assert (code, "saddle is not positive" in text) == (1, True)
        assert valid(path) is None
    path.write_text(json.dumps(rim), encoding="utf-8")
    code, text = run(verifier, path)
    assert (code, "needs four boundary vertices" in text) == (1, True)
    assert valid(path) is None


def apex_first() -> dict[str, Any]:
    """A branch of a sheet whose first vertex is opposite to three boundary vertices in line."""
    points = [(1, 3), (0, 0), (1, 0), (2, 0), (1, 1)]
    sheet = CreasePattern(points, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    return branch_certificate(find_branch(sheet, "+"))


def negated(branch: dict[str, Any]) -> dict[str, Any]:
    """The same certificate, seen from the other side: heights, signs and letters."""
    claims, evidence = branch["claims"], branch["evidence"]
    heights = [str(-int(h)) for h in evidence["heights"]]
    letters = claims["assignment"].translate(str.maketrans("MV", "VM"))
    signs = [-s for s in claims["vertex_signs"]]
    return branch | {
        "claims": claims | {"vertex_signs": signs, "assignment": letters},
        "evidence": evidence | {"heights": heights},
    }


def check_mutations(verifier: Path, given: Path, path: Path, count: int, seed: int) -> None:
    """A changed letter is refused; changed digits of heights change nothing that is proved."""
    rng = random.Random(seed)
    whole = bodies(given.read_bytes())
    shown = run(verifier, given)[1]
    for _ in range(count):
        lines = bodies(given.read_bytes())
        letters = rng.random() < 0.5
        data = raw(lines[1], "folds" if letters else "centers")
        place = rng.randrange(len(data))
        data[place] ^= 1 << rng.randrange(5 if letters and place % 2 else 8)
        put(lines[1], "folds" if letters else "centers", data)
        path.write_bytes(chained(lines))
        code, text = run(verifier, path)
        root = place // (2 if letters else 4 * whole[1]["width"])
        if letters or code:
            assert code == 1
            assert f"NOT VERIFIED  root {root} did not pass the test" in text
        else:
            assert text == shown


@pytest.mark.slow
def test_changed_letters_and_heights(verifier: Path, notch: Path, tmp_path: Path) -> None:
    check_mutations(verifier, CONVEX, tmp_path / "changed.txt", 100, seed=1)
    check_mutations(verifier, notch, tmp_path / "changed.txt", 50, seed=3)


@pytest.mark.survey
def test_two_thousand_changed_letters_and_heights(
    verifier: Path, notch: Path, tmp_path: Path
) -> None:
    check_mutations(verifier, CONVEX, tmp_path / "changed.txt", 2000, seed=2)
    check_mutations(verifier, notch, tmp_path / "changed.txt", 2000, seed=4)


@pytest.mark.slow
def test_both_checkers_agree_on_changed_certificates(verifier: Path, tmp_path: Path) -> None:
    mutate(tmp_path, 100, seed=3)
    paths = sorted(tmp_path.iterdir())
    assert len(paths) > 80
    assert compare(verifier, paths) == 0


def _drawn(pattern: CreasePattern, **changes: object) -> str:
    """A drawing with the text of each number in decimals; all coordinates are dyadic."""
    points = [[float(x), float(y), 0.0] for x, y in pattern.vertices]
    faces = [list(face[k % 3 :] + face[: k % 3]) for k, face in enumerate(pattern.triangles)]
    faces[0].reverse()
    document = {"file_title": 'a "title" \\', "vertices_coords": points, "faces_vertices": faces}
    return json.dumps({**document, **changes})


@pytest.mark.slow
def test_the_sheet_is_that_of_a_drawing(verifier: Path, tmp_path: Path) -> None:
    pattern = sample_random_square(3, 8).pattern
    stream_branches(pattern, tmp_path / "c")
    drawing = tmp_path / "d.fold"

    def compared(text: str) -> tuple[int, str]:
        drawing.write_text(text)
        code, said = run(verifier, tmp_path / "c", drawing)
        assert (code == 0) == (f"drawing   {drawing} has these vertices and faces" in said)
        assert (code == 0) == ("VERIFIED" in said)
        return code, said

    points = [[float(x), float(y)] for x, y in pattern.vertices]
    exact = [[str(x), str(y)] for x, y in pattern.vertices]
    rounded = [[round(x, 12), round(y, 12)] for x, y in points]
    key = "vertices_exactfold:coords"
    written = (f"{x * 1000:.13f}e-03" if x else "-0E+2" for point in points for x in point)
    for text in (
        _drawn(pattern),
        _drawn(pattern, vertices_coords=points),
        _drawn(pattern, **{key: exact, "vertices_coords": rounded}),
        re.sub(
            '"x"',
            lambda _: next(written),
            _drawn(pattern, vertices_coords=[["x"] * 2] * len(exact)),
        ),
    ):
        assert compared(text)[0] == 0, text
    moved = [*points[:-1], [points[-1][0], points[-1][1] + 2**-40]]
    faces = [list(face) for face in pattern.triangles]
    several = [*faces[:-1], faces[0]]
    last = len(points) - 1
    for changes, code, why in (
        ({"vertices_coords": moved}, 1, f"vertex {last} of the drawing is not at its place"),
        ({"vertices_coords": points[:-1]}, 1, f"has {last} vertices, the certificate {last + 1}"),
        ({"faces_vertices": faces[:-1]}, 1, "the faces of the drawing are not those"),
        ({"faces_vertices": several}, 1, "the faces of the drawing are not those"),
        ({"faces_vertices": [[0, 1, 2, 3]]}, 3, "has not three vertices"),
        ({"faces_vertices": None}, 3, "faces_vertices is no list"),
        ({"vertices_coords": [[0, 0, 1]]}, 3, "not in the plane"),
        ({"vertices_coords": [["0", 0]]}, 3, "is no number"),
        ({key: [*exact[:-1], ["1/3", "1/3"]]}, 3, f"vertex {last} of the drawing has two"),
        ({key: exact[:-1]}, 3, "exact coordinates of other vertices"),
        ({"vertices_exactfold:surds": []}, 3, "square roots"),
    ):
        found, said = compared(_drawn(pattern, **changes))
        assert (found, why in said) == (code, True), said
        assert code == 1 or f"exactfold-verify: {drawing}: " in said
    assert compared("\ufeff" + _drawn(pattern))[0] == 0
    escaped = _drawn(pattern, **{key: [*exact[:-1], ["1/3", "1/3"]]}).replace(
        "coords", "coord\\u0073"
    )
    found, said = compared(escaped)
    assert (found, "escapes in keys are not read" in said) == (3, True)
    (tmp_path / "d.fold").unlink()
    code, said = run(verifier, tmp_path / "c", drawing)
    assert (code, f"exactfold-verify: {drawing}: " in said) == (3, True)
    assert compared(_drawn(pattern).replace('"faces_vertices"', '"faces"'))[0] == 3
    for number in ("1e5000", "1.2.3", "--1", "1e", ".", "0e-4611686018427387904"):
        text = _drawn(pattern).replace("0.0", number, 1)
        assert compared(text)[0] == 3, number


@pytest.mark.slow
def test_a_drawing_far_from_the_origin(verifier: Path, tmp_path: Path) -> None:
    """Exact coordinates may differ from decimals by what is small on the drawing, or rounding."""
    far = 10**9 + Fraction(1, 3)
    near = sample_random_square(2, 3).pattern
    pattern = CreasePattern([(x + far, y + far) for x, y in near.vertices], near.triangles)
    stream_branches(pattern, tmp_path / "c")
    drawing = tmp_path / "d.fold"
    exact = [[str(x), str(y)] for x, y in pattern.vertices]
    for moved, code in ((0.0, 0), (0.25, 3)):
        points = [[float(x), float(y)] for x, y in pattern.vertices]
        points[-1][0] -= moved
        changes = {"vertices_exactfold:coords": exact, "vertices_coords": points}
        drawing.write_text(_drawn(pattern, **changes))
        found, said = run(verifier, tmp_path / "c", drawing)
        assert (found, "has two different places" in said) == (code, code == 3), said


@pytest.mark.slow
def test_the_side_from_which_a_listing_shows_a_branch(verifier: Path, tmp_path: Path) -> None:
    """Both branches of the dart have the sign - in the file; a sign vector agrees with one."""
    source = CERTIFICATES / "listing-dart.json"
    code, text = run(verifier, source)
    assert code == 0
    assert "Seen from the side on which\n          vertex 1 pops up" in text
    assert "each sign vector agrees with one" in text
    assert "Each sign vector" not in text
    path = tmp_path / "forged.json"
    mirror = str.maketrans("+-MV", "-+VM")
    shown: list[tuple[int, dict[str, str], str]] = [
        (1, {"representative": "either"}, 'is shown, not "either"'),
        (1, {"representative": "either", "vertex_signs": "+", "assignment": "MVMM"}, "is shown"),
        (1, {"vertex_signs": "+", "assignment": "MVMM"}, "branch 1 did not pass the test"),
        (1, {"vertex_signs": "0"}, "branch 1 did not pass the test"),
        (0, {"assignment": "FVFF"}, "branch 0 did not pass the test"),
    ]
    for number, changes, said in shown:
        given = json.loads(source.read_text(encoding="utf-8"))
        given["claims"]["branches"][number] |= changes
        path.write_text(json.dumps(given), encoding="utf-8")
        code, text = run(verifier, path)
        assert (code, said in text) == (1, True), text
        assert valid(path) is None
    assert "VMVV".translate(mirror) == "MVMM"
    given = json.loads((CERTIFICATES / "listing-reflex-either-side.json").read_text("utf-8"))
    for center, known in ((0, True), (1, False)):
        root = given["evidence"]["roots"][1]
        root |= {"center": [str(int(root["center"][0]) + center)], "radius": "4"}
        path.write_text(json.dumps(given), encoding="utf-8")
        code, text = run(verifier, path)
        assert code == 0
        assert ("not verified here: that the saddle of 1 branch" in text) != known
        assert valid(path) is not None
    root["radius"] = "-1"
    path.write_text(json.dumps(given), encoding="utf-8")
    assert run(verifier, path)[0] == 3
    assert valid(path) is None


@pytest.mark.slow
def test_the_last_corner_has_a_positive_saddle(verifier: Path, tmp_path: Path) -> None:
    """A program that proposes another corner stops."""
    place = tmp_path / "verify"
    shutil.copytree(verifier.parent, place)
    proposing = place / "proposing.ml"
    text = proposing.read_text(encoding="utf-8")
    assert text.count("    choose 1\n") == 1
    proposing.write_text(text.replace("    choose 1\n", "    choose 2\n"), encoding="utf-8")
    makefile = (verifier.parent.parent / "Makefile").read_text(encoding="utf-8")
    files = re.findall(r"\w+\.mli?\b", makefile.partition("-linkpkg")[2].partition("-o")[0])
    line = ["ocamlfind", "ocamlopt", "-w", "-a", "-package", "zarith", "-linkpkg"]
    subprocess.run([*line, *files, "-o", "other"], cwd=place, check=True)
    code, text = run(place / "other", CONVEX)
    assert (code, "does not have a positive saddle" in text) == (70, True)
    assert run(verifier, CONVEX)[0] == 0


@pytest.mark.slow
def test_no_vertex_at_which_a_letter_ends_is_not_mentioned(verifier: Path, tmp_path: Path) -> None:
    given = json.loads(RANDOM.read_text(encoding="utf-8"))
    given["claims"]["assignment"] = "U" * len(given["claims"]["assignment"])
    path = tmp_path / "open.json"
    path.write_text(json.dumps(given), encoding="utf-8")
    code, text = run(verifier, path)
    assert (code, "0 vertices" in text, "M and V" in text) == (0, False, False)
    assert "By theorem one_verified" in text


@pytest.mark.slow
def test_help_and_bad_arguments(verifier: Path, tmp_path: Path) -> None:
    assert subprocess.run([verifier, "--help"], capture_output=True, check=False).returncode == 0
    assert subprocess.run([verifier], capture_output=True, check=False).returncode == 2
    code, text = run(verifier, tmp_path / "missing.json")
    assert (code, "No such file" in text) == (3, True)


@pytest.mark.slow
def test_exact_heights_continue_where_no_vertex_is_flat(verifier: Path, tmp_path: Path) -> None:
    square = CreasePattern(
        [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    )
    given = branch_certificate(find_branch(square, "+"))
    given["evidence"] |= {"heights": ["2", "0", "0", "0", "1"], "denominator": "2"}
    path = tmp_path / "exact.json"
    path.write_text(json.dumps(given), encoding="utf-8")
    code, text = run(verifier, path)
    assert code == 0
    assert "By theorem exact_verified" in text
    assert "by theorem exact_continues" in text
