"""The document of the page against counts and motions, and the page against its document."""

import base64
import hashlib
import itertools
import json
import re
from fractions import Fraction
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest
from jsonschema import Draft202012Validator, ValidationError

import exactfold
from exactfold import CreasePattern, Opened, PanelPattern, delaunay, random_square, schema
from exactfold._support.clock import Clock
from exactfold.app.pictures import crease_style
from exactfold.app.report.connected_components import piece_notes
from exactfold.app.viewer import page as page_module
from exactfold.app.viewer import view_document as view_all
from exactfold.app.viewer import view_page
from exactfold.app.viewer.coding import coded_frames, decoded_frames, levelled
from exactfold.app.viewer.document import Known
from exactfold.branches import count_branches, count_ways, find_branch
from exactfold.branches.counting.pools import process_pool
from exactfold.design import match_panels
from exactfold.errors import UsageError
from exactfold.exact.numbers import outward
from exactfold.motion import follow, follow_panels, panel_ways, prove, prove_contacts
from exactfold.pattern.families import single_vertex
from exactfold.pattern.loading import open_sheet
from exactfold.solve.certify import algebraic

view_document = partial(view_all, flat=False)  # flat-folded states: test_folded.py
PAGE = Path(page_module.__file__).parent / "page"
HEXAGON = [(4, 0), (2, 3), (-2, 3), (-4, 0), (-2, -3), (2, -3)]
CORNER_AND_CENTRE = CreasePattern(
    [*HEXAGON, (0, 0), (5, 3)], [*((k, (k + 1) % 6, 6) for k in range(6)), (0, 7, 1)]
)
"""A hexagon with a vertex in the middle, and a corner with a fold from border to border."""


@cache
def document_of(name):
    """The document of a shipped pattern with few frames, made once: no test changes it."""
    return view_document(name, frames=3)


@pytest.fixture(scope="module")
def two_vertex():
    return view_document("two-vertex", frames=7)


def test_branches_are_those_of_the_count(two_vertex):
    count = count_branches("two-vertex")
    folds = count.pattern.folds
    assert two_vertex["sheet"]["folds"] == [list(fold) for fold in folds]
    assert [(way["signs"], way["letters"], way["saddle"]) for way in two_vertex["ways"]] == [
        (branch.sign_text, "".join(branch.assignment[fold] for fold in folds), branch.saddle)
        for branch in count
    ]
    assert (two_vertex["status"], two_vertex["complete"]) == ("proved", True)
    assert two_vertex["answer"].startswith("4 ways to start folding - PROVED; all real")


def test_frames_are_those_of_the_motion_and_of_its_mirror_image(two_vertex):
    way = two_vertex["ways"][1]
    branch = find_branch("two-vertex", way["signs"])
    frames = decoded_frames(way["motion"])
    for side, seen in ((1, frames), (-1, frames * [1, 1, -1])):
        motion = follow(branch, side=side, frames=7)
        assert np.abs(levelled(motion.coords) - seen).max() < 3e-7 * way["motion"]["scale"]
        assert way["motion"]["duration"] == pytest.approx(motion.duration, rel=1e-9)
    assert way["motion"]["end"] == "flat-fold"
    assert (way["motion"]["proved"], way["why"]) == (False, "")


@pytest.mark.slow
def test_motions_are_proved_where_that_is_asked_for():
    [way] = view_document("two-vertex", branches=["+-"], frames=3, proving=True)["ways"]
    event = prove(follow(find_branch("two-vertex", "+-"))).contact.event
    assert way["motion"]["proved"]
    assert "between the times {} and {}".format(*outward(*event.time)) in way["motion"]["said"]


@pytest.mark.slow
def test_vertices_to_look_at_are_marked_with_reasons():
    marks = document_of("zigzags")["sheet"]["marks"]
    assert [(mark["vertex"], mark["kind"]) for mark in marks] == [
        (v, "refuted") for v in (9, 10, 13, 14)
    ]
    assert marks[1]["text"] == (
        "It cannot start to fold with the letters of the file: its mountains 10-14, 6-10 lie on "
        "one side of a line, and so do its valleys 9-10, 10-11: exchange the letter of 6-10"
    )
    assert document_of("miura")["sheet"]["marks"] == []


def test_a_vertex_that_is_open_and_one_that_does_not_fold_flat_are_marked():
    tiny = Fraction(1, 10**9)
    rim = [(1, 2), (2, 3), (3, 4), (1, 4)]
    for bent, letters, kind, text in (
        (tiny, "VMMM", "open", "Whether it can start to fold is open: folds 0-2 and 0-4 miss a"),
        (Fraction(0), "MFMF", "", ""),
    ):
        sheet = PanelPattern(
            [(0, 0), (1, 0), (0, 1), (-1, 0), (bent, -1)], [*rim, *((0, k) for k in range(1, 5))]
        )
        opened = Opened(sheet, {(0, k): x for k, x in enumerate(letters, 1)})
        marks = view_document(opened, frames=3)["sheet"]["marks"]
        assert [mark["kind"] for mark in marks] == ([kind] if kind else [])
        assert all(mark["text"].startswith(text) for mark in marks)
    square = [(2, 0), (2, 2), (-2, 2), (-2, -2), (2, -2)]
    waterbomb = PanelPattern(
        [(0, 0), *square[1:], (2, 0), (-2, 0)],
        [(1, 2), (3, 4), (1, 5), (4, 5), (2, 6), (3, 6), *((0, k) for k in range(1, 7))],
    )
    letters = {(0, k): x for k, x in enumerate("VVVVMM", 1)}
    assert view_document(Opened(waterbomb, letters), frames=3)["sheet"]["marks"] == []
    letters[0, 5] = "V"
    [mark] = view_document(Opened(waterbomb, letters), frames=3)["sheet"]["marks"]
    assert (mark["vertex"], mark["kind"]) == (0, "flat")
    assert mark["text"] == "It does not fold flat: mountains and valleys do not differ by 2"


def test_levelled_frames_keep_all_distances():
    motion = follow(find_branch("two-vertex", "+-"), frames=9)
    shapes = levelled(motion.coords)
    apart = [c[:, :, None] - c[:, None] for c in (motion.coords, shapes)]
    assert np.allclose(*(np.linalg.norm(a, axis=3) for a in apart), atol=1e-12)
    assert np.abs(np.diff(shapes, axis=0)).max() <= np.abs(np.diff(motion.coords, axis=0)).max()


@pytest.mark.parametrize("shape", [(2, 1, 3), (3, 4, 3), (40, 5, 3)])
def test_any_frames_survive_coding(shape):
    coords = np.random.default_rng(7).normal(size=shape)
    coded = coded_frames(coords)
    assert np.abs(decoded_frames(coded) - coords).max() <= coded["scale"] / 2**24
    assert coded_frames(np.zeros(shape))["scale"] == 1.0


def test_the_branches_that_are_named_are_shown():
    document = view_document(random_square(12, seed=1), branches=["+-" * 6, "-" * 12], frames=2)
    assert [way["signs"] for way in document["ways"]] == ["+-" * 6, "-" * 12]
    assert (document["complete"], document["status"]) == (False, "proved")
    with pytest.raises(UsageError, match="3 signs for 12 vertices"):
        view_document(random_square(12, seed=1), branches=["+-+"])
    with pytest.raises(UsageError, match="modes of rigid panels"):
        view_document("zigzags", branches=["+-+"])


def test_a_branch_with_a_flat_vertex_has_the_reason_in_place_of_a_motion():
    document = document_of("flat-vertex")
    flat = next(way for way in document["ways"] if "0" in way["signs"])
    assert flat["motion"] is None
    assert "is flat on this branch" in flat["why"]
    assert (flat["status"], flat["multiplicity"]) == ("proved", 2)


def test_panels_list_what_is_followed_and_what_is_not():
    ways = count_ways("zigzags")
    document = document_of("zigzags")
    listed = [way for way in panel_ways(ways) if not way.why_not_followed]
    followed = [way for way in document["ways"] if way["motion"]]
    assert (document["kind"], len(followed)) == ("panels", len(listed))
    [left] = [way for way in document["ways"] if way["motion"] is None]
    assert (left["status"], left["name"]) == ("refuted", "way 4")
    assert "does not close" in left["why"]
    assert set(left["letters"]) == {"M", "V"}
    assert [way["motion"]["proved"] for way in followed].count(True) == 1
    assert all(way["motion"]["exists"] for way in followed)


@pytest.mark.parametrize("name", ["flat-vertex", "zigzags", "waterbomb"])
def test_documents_are_what_their_schema_says(name):
    document = json.loads(json.dumps(document_of(name)))
    Draft202012Validator(schema("view")).validate(document)
    wrong = document | {"complete": "yes"}
    with pytest.raises(ValidationError, match="'yes' is not of type 'boolean'"):
        Draft202012Validator(schema("view")).validate(wrong)


@pytest.mark.slow
def test_it_says_what_is_proved_of_a_motion_of_panels():
    said = [way["motion"]["said"] for way in document_of("zigzags")["ways"][:3]]
    growing = "it exists until a fold reaches 180 degrees, and all angles grow; "
    assert said[0].startswith(f"{growing}the drawing and the contacts are computed in floats")
    exact = "every vertex closes exactly at all fold angles; "
    assert said[2] == exact + "contacts were found in floats"
    ways = view_document("zigzags", frames=2, proving=True)["ways"]
    proved = f"{growing}its first contact is proved to be between the times "
    assert ways[0]["motion"]["said"].startswith(proved)
    assert "; the drawing is computed in floats; faces stay rigid" in ways[0]["motion"]["said"]
    assert (ways[0]["motion"]["proved"], ways[0]["motion"]["exists"]) == (False, True)
    way = ways[2]
    event = prove_contacts(follow_panels(count_ways("zigzags"), way=3)).event
    low, high = outward(*event.time)
    times = f"its first contact is proved to be between the times {low} and {high}"
    assert way["motion"]["said"] == exact + times


def test_graphs_over_the_boundary_heights_are_families_with_a_motion_each():
    document = view_document(CORNER_AND_CENTRE, frames=3)
    assert "1 family of ways to fold, of dimension 4" in document["answer"]
    assert document["complete"]
    [way] = document["ways"]  # the other graph is its mirror image
    branch = find_branch(CORNER_AND_CENTRE, "+")
    assert (way["signs"], way["letters"]) == ("+", branch.assignment_text)
    assert way["family"]["dimension"] == 4
    folds = [document["sheet"]["folds"][k] for k in way["family"]["drivers"]]
    assert len({tuple(fold) for fold in folds}) == 4
    assert [0, 1] in folds  # it goes from border to border, and nothing else turns it


@pytest.mark.slow
def test_families_of_panels_have_a_representative_each_and_the_letters_of_the_file_come_first():
    document = view_document("bird-base", frames=3)
    matched = match_panels("bird-base")
    assert document["answer"].startswith("16 families of ways to fold, each of dimension 5")
    first, *others = document["ways"]
    assert document["drawn"] == {"way": 0, "mirrored": False}
    assert first["letters"] == "".join(matched.letters[f] for f in matched.pattern.folds)
    assert [way["name"] for way in others] == [
        f"way {k}, a family of dimension 5" for k in range(1, 17)
    ]
    assert len({way["letters"] for way in others}) == 16
    for way in document["ways"]:
        assert (way["family"]["dimension"], len(way["family"]["drivers"])) == (5, 5)
        frames = decoded_frames(way["motion"])
        for i, j in document["sheet"]["fold"]["edges_vertices"]:
            lengths = np.linalg.norm(frames[:, i] - frames[:, j], axis=1)
            assert np.allclose(lengths, lengths[0], rtol=1e-5)
        assert np.ptp(frames[-1][:, 2]) > 0.05 * way["motion"]["scale"]


def test_a_listed_way_that_has_the_letters_of_the_file_is_named():
    document = document_of("miura")
    drawn = document["drawn"]
    turned = str.maketrans("MV", "VM") if drawn["mirrored"] else {}
    letters = document["ways"][drawn["way"]]["letters"].translate(turned)
    assert letters == document["sheet"]["letters"]
    assert document_of("zigzags")["drawn"] is None  # the sheet does not fold with its letters


def test_a_rigid_sheet_opens_with_the_reason():
    document = view_document(single_vertex(3))
    assert (document["status"], document["ways"]) == ("proved", [])
    assert document["answer"].startswith("0 ways to start folding")
    assert document["reason"]
    assert view_page(document).count("</script>") == 3


def test_an_undecided_count_shows_what_is_known(monkeypatch):
    monkeypatch.setattr(algebraic, "definite_stress", lambda pattern: None)
    known = count_branches("flat-vertex")
    document = view_document("flat-vertex", frames=2)
    assert (document["status"], document["complete"]) == ("undecided", False)
    assert "finiteness is not proved" in document["reason"]
    assert "UNDECIDED" in document["answer"]
    assert [way["signs"] for way in document["ways"]] == [b.sign_text for b in known]


def test_lines_look_as_in_pictures(two_vertex):
    page = view_page(two_vertex)
    for letter, colour in crease_style.COLOUR.items():
        assert f"--{letter}: {colour}" in page
    look = json.loads(re.search(r"^const LOOK = (.*);$", page, re.MULTILINE)[1])
    style = crease_style.Style.of(100.0)
    for letter, line in look["letters"].items():
        assert line["most"] == style.width(letter, 1.0)
        dash = style.attributes(letter)["stroke_dasharray"]
        assert " ".join(f"{x:g}" for x in line["dash"]) == (dash or "")


def test_a_sheet_without_ways_keeps_the_letters_of_its_file():
    sheet = document_of("waterbomb")["sheet"]
    opened = open_sheet("waterbomb")
    assert sheet["letters"] == "".join(opened.assignment.get(e, "U") for e in opened.sheet.folds)


def test_no_name_runs_as_code_or_breaks_the_page():
    name = "</script><script>alert(1)</script><!-- \u2028 & \"'"
    page = view_page(view_document("single-vertex-4", name=name, frames=2))
    assert page.count("</script>") == page.count("<script") == 3
    assert "&lt;/script&gt;&lt;script&gt;" in page
    assert _data(page)["name"] == name


def test_scripts_and_styles_are_allowed_by_their_digests_and_nothing_else_is(two_vertex):
    page = view_page(two_vertex)
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', page)[1]
    code = re.findall(r"<script(?: type=\"module\")?>(.*?)</script>", page, re.DOTALL)
    texts = [*code, re.search(r"<style>(.*?)</style>", page, re.DOTALL)[1]]
    for text in texts:
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"'sha256-{digest}'" in policy
    assert "unsafe" not in policy
    assert "default-src 'none'" in policy
    assert "connect-src 'none'" in policy
    addresses = set(re.findall(r"https?://[\w./-]+", page))
    assert addresses <= {"http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg", *_specs()}
    assert _data(page) == json.loads(json.dumps(two_vertex))


def _specs():
    """Addresses that name things in data, none of which is opened."""
    document = view_document(single_vertex(3))["sheet"]["fold"]
    return re.findall(r"https?://[\w./-]+", json.dumps(document))


def test_modules_of_the_page_can_be_joined():
    """They become one script: no name may stand in two of them."""
    names, texts = [], {path.name: path.read_text("utf-8") for path in PAGE.glob("*.js")}
    for text in texts.values():
        names += re.findall(
            r"^(?:export )?(?:async )?(?:function|const|let|class) (\w+)", text, re.MULTILINE
        )
        assert len(text.splitlines()) < 400
    assert len(names) == len(set(names))
    script = _script(view_page(view_document(single_vertex(3))))
    assert not re.search(r"^(import|export)\b", script, re.MULTILINE)
    assert all(f"// --- {name} ---" in script for name in texts)


def _data(page):
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    return json.loads(found[1])


def _script(page):
    return re.search(r'<script type="module">(.*?)</script>', page, re.DOTALL)[1]


@pytest.mark.slow
def test_ways_have_the_same_numbers_in_the_page_in_fold_and_in_count():
    corners = [(0, 0), (10, -3), (16, 5), (9, 14), (-2, 9)]
    sheet = delaunay([*corners, (5, 4), (8, 7)])
    document = view_document(sheet, frames=2)
    numbers = [way["number"] for way in document["ways"]]
    assert numbers == [*range(1, len(numbers) + 1)]
    for way in document["ways"]:
        assert exactfold.follow(sheet, way["number"], frames=2).branch.sign_text == way["signs"]
    said = " ".join(str(line) for line in piece_notes(count_ways(sheet)))
    assert f"ways 1 to {len(numbers)} are the families" in said
    for name in ("two-vertex", "zigzags"):
        listed = document_of(name)["ways"]
        assert [way["number"] for way in listed] == [*range(1, len(listed) + 1)]


def test_ways_that_are_not_begun_in_time_say_so_and_how_they_are_followed():
    """The way with the letters of the file is the first that is followed."""
    known = Known.of("miura", frames=3)
    drawn = known.known.drawn["way"]
    order = []

    def pool(work, jobs):
        for job in itertools.islice(jobs, 2):
            order.append(job[0])
            yield job, work(job)

    ways = known.followed(pool, Clock(60), None)
    assert order[0] == drawn
    assert [way["motion"] is not None for way in ways] == [k in order for k in range(8)]
    late = known.followed(process_pool(1), Clock(0), None)
    said = "the time limit of 0 seconds (--limit) was reached; `exactfold view` or `fold` with"
    assert [way["why"] for way in late] == [
        f"{said} --way {k} follows it alone" for k in range(1, 9)
    ]
    assert all(way["motion"] is None for way in late)
