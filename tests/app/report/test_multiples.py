"""Sheets of small multiples: the order of `count`, frames round ways with the same letters."""

import re
from dataclasses import replace

import pytest
from svg_reading import NAME, letters, of_class, tree, words

from exactfold.app.pictures.drawn_ways import ways_of
from exactfold.app.pictures.multiples import sheet_of_multiples
from exactfold.app.pictures.way_sheets import number_listed, sheet_of_ways, why_no_way
from exactfold.branches import Branch, count_ways
from exactfold.errors import UsageError
from exactfold.motion import panel_ways
from exactfold.panels.decomposition import decompose
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels


def numbers(text):
    return [int(g.get("data-way")) for g in of_class(text, "way")]


def frames(text):
    return [w for w in words(text) if "the same letters" in w]


@pytest.fixture(scope="module", params=["flat-octahedron", "zigzags"])
def counted(request):
    return count_ways(request.param)


def test_all_ways_stand_in_the_order_of_the_count(counted):
    ways = ways_of(counted)
    listed = getattr(counted, "branches", None) or panel_ways(counted)
    assert len(ways) == len(listed) >= 4
    for way, one in zip(ways, listed, strict=True):
        own = one.assignment if isinstance(one, Branch) else one.letters
        assert {f: a for f, a in way.letters.items() if a != "F"} == {
            f: a for f, a in own.items() if a != "F"
        }
    text = sheet_of_multiples(ways, "all")
    assert numbers(text) == list(range(1, len(ways) + 1))
    assert frames(text) == []
    for group, way in zip(of_class(text, "way"), ways, strict=True):
        drawn = {p.get("class") for p in group.iter(f"{NAME}path")} - {None}
        assert drawn == {*way.letters.values(), "B"}


def test_captions_tell_number_signs_and_letters():
    result = count_ways("two-vertex")
    said = words(sheet_of_multiples(ways_of(result), "two & more"))
    for k, branch in enumerate(result.branches, 1):
        assert f"{k}: {branch.sign_text}" in said
        assert branch.assignment_text in said
    assert said[0] == "two & more"


def test_a_title_wider_than_the_ways_is_not_cut():
    ways = ways_of(count_ways("two-vertex"))[:1]
    narrow, wide = (tree(sheet_of_multiples(ways, title)) for title in ("one", 40 * "wide "))
    assert float(narrow.get("width")) < 200
    assert float(wide.get("width")) > 200 * 6.5
    middle = float(wide.get("width")) / 2
    (way,) = [one for one in wide.iter(f"{NAME}g") if one.get("class") == "way"]
    captions = [float(one.get("x")) for one in way.iter(f"{NAME}text")]
    assert captions == pytest.approx([middle] * len(captions), abs=0.1)
    assert len(captions) == 2


def test_ways_with_the_same_letters_stand_in_one_frame():
    ways = list(ways_of(count_ways("two-vertex")))
    same = [ways[0], ways[1], replace(ways[3], letters=ways[0].letters, number=3), ways[2]]
    text = sheet_of_multiples(same, "t")
    assert numbers(text) == [1, 3, 2, 3]
    assert frames(text) == ["1, 3: the same letters"]
    exchanged = {"M": "V", "V": "M"}
    other = {fold: exchanged[letter] for fold, letter in ways[0].letters.items()}
    turned = [ways[0], replace(ways[1], letters=other)]
    assert frames(sheet_of_multiples(turned, "t")) == ["1, 2: the same letters from opposite sides"]


def test_modes_that_do_not_fold_are_faint_and_say_so():
    text = sheet_of_multiples(ways_of(count_ways("zigzags")), "t")
    faint = [g.get("data-way") for g in of_class(text, "way") if g[0].get("opacity")]
    assert faint == ["4"]
    assert words(text).count("does not truly fold") == 1


def test_undecided_letters_are_not_shared():
    ways = ways_of(count_ways("two-vertex"))
    unknown = [replace(way, letters=dict.fromkeys(way.letters, "U")) for way in ways]
    assert frames(sheet_of_multiples(unknown, "t")) == []


def test_a_sheet_says_how_many_ways_are_left_out():
    ways = ways_of(count_ways("flat-octahedron"), 3)
    assert [way.number for way in ways] == [1, 2, 3]
    text = sheet_of_multiples(ways, "t", number=8)
    assert numbers(text) == [1, 2, 3]
    assert "and 5 more" in words(text)
    with pytest.raises(UsageError, match="no way to draw"):
        sheet_of_multiples([], "t")


def test_pictures_stand_apart(counted):
    text = sheet_of_multiples(ways_of(counted), "t")
    corners = [
        g.find(f"{NAME}g").get("transform").removeprefix("translate(").rstrip(")").split()
        for g in of_class(text, "way")
    ]
    assert len(set(map(tuple, corners))) == len(corners)
    width = float(tree(text).get("width"))
    assert all(0 <= float(x) < width - 100 for x, _ in corners)
    assert letters(text)["B"] == len(corners)


@pytest.mark.parametrize(
    ("name", "most", "number", "title"),
    [
        ("two-vertex", None, 4, "two-vertex: 4 ways to start folding, proved"),
        ("hypar-2", 3, 256, "hypar-2: 256 ways to start folding, proved"),
        ("zigzags", None, 4, "zigzags: 4 ways, 3 of them known to truly fold"),
        ("zigzags", 2, 4, "zigzags: the first 2 of 4 ways"),
        pytest.param(
            "flapping-bird",
            None,
            20,
            "flapping-bird: 20 ways, all known to truly fold",
            marks=pytest.mark.slow,
        ),
        ("windmill", None, 6, "windmill: 6 ways, all known to truly fold"),
    ],
)
def test_the_title_says_what_is_known_of_the_ways(name, most, number, title):
    result = count_ways(name)
    text = sheet_of_ways(result, name, most)
    assert number_listed(result) == number
    assert words(text)[0] == title
    assert len(numbers(text)) == min(most or number, number)


def test_a_count_without_a_list_has_no_sheet_error():
    result = count_ways("waterbomb")
    assert number_listed(result) == 0
    assert why_no_way(result).startswith("there are infinitely many ways to fold")
    with pytest.raises(UsageError, match="no way to draw"):
        sheet_of_ways(result, "waterbomb")


def test_why_families_of_panels_have_no_sheet():
    result = decompose(panels(single_vertex(5)))
    assert why_no_way(result).startswith("the sheet folds in families")


def test_folds_of_either_letter_have_one_look_and_a_line_in_the_legend():
    """A way that has folds of either letter only looks like the others."""
    ways = ways_of(count_ways("bird-base"))
    (free,) = (way for way in ways if set(way.text) == {"U"})
    for text in (sheet_of_multiples(ways, "bird base"), free.picture("bird base")):
        assert ">mountain or valley</text>" in text
        assert "undecided" not in text
        lines = re.findall(r'<(?:path|g) [^>]*stroke="#5c6670"[^>]*>', text)
        assert lines
        assert all("stroke-dasharray" in line for line in lines)
