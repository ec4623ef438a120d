"""Certificates of sheets of panels: what the checker accepts, and a forgery for what it refuses."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest
from forge import beyond, refused, verified
from forge_panels import SHEETS, Document, certified, drawn, matched, stopped
from panel_sheets import grid, joined_twists, ring_of_fives

from exactfold import checker
from exactfold.checker.core.intervals import Interval
from exactfold.checker.panels import certificate as panels
from exactfold.checker.panels import components as panel_components
from exactfold.checker.panels import loops as panel_loops
from exactfold.checker.panels import modes as panel_modes
from exactfold.checker.sheets import panels as panel_sheet
from exactfold.errors import NotApplicableError
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose

BITS = 400
KNOWN = {
    "miura": {"1": 8},
    "two rows": {"1": 3, "2": 1},
    "three rows": {"1": 7, "3": 1},
    "strip": {"1": 32},
    "long strip": {"1": 1 << 20},
    "tiling": {"1": 2},
    "rigid": {"0": 1},
    "twist": {"1": 6},
    "crossing": {"2": 2},
    "square": {"1": 1},
    "bent": {"1": 3, "2": 1},
    "split": {"1": 3, "2": 1},
    "surds": {"1": 4},
    "nested": {"1": 2},
}


@pytest.mark.parametrize("name", SHEETS)
def test_valid(name: str) -> None:
    claims = verified(certified(name))
    assert claims["second_order"] == KNOWN[name]
    assert claims["true"] == ({"1": 2, "2": 1} if name in ("bent", "split") else KNOWN[name])
    assert claims["rigid"] == ("proved" if name == "rigid" else "refuted")


def test_summary(tmp_path: Path) -> None:
    path = tmp_path / "bent.json"
    path.write_text(json.dumps(certified("bent")))
    claims = checker.verify(path)
    assert checker.summary(claims) == (
        "VALID: the motions of the sheet of 12 folds and 4 interior vertices have the components "
        "3 of dimension 1, 1 of dimension 2 to second order, and those of the true motions are "
        "2 of dimension 1, 1 of "
        f"dimension 2; sha256 {claims['sha256']}"
    )


def test_folds_held_flat() -> None:
    claims = verified(certified("square", [(4, 5)]))
    assert claims["second_order"] == claims["true"] == {"0": 1}
    assert claims["held"] == claims["flat"] == [[4, 5]]
    assert ", 1 fold held flat have" in checker.summary(claims)
    assert (
        "of dimension 0 to second order, and those of the true motions are the same; sha256"
        in checker.summary(claims)
    )
    for fold in ((5, 6), (5, 9)):  # so that a straight pair along x, along y is left
        inner = certified("crossing", [fold])
        assert verified(inner)["second_order"] != KNOWN["crossing"]


@pytest.mark.usefixtures("without_spaces")
def test_no_certificate_of_what_is_not_decided() -> None:
    """The search for the spaces of three vertices with five folds each ends at once."""
    with pytest.raises(NotApplicableError, match="this one is undecided"):
        certificate_of_panels(decompose(ring_of_fives()))


def test_an_undecided_extension_claims_nothing() -> None:
    made = certified("tiling")
    [support] = made["claims"]["supports"]
    support["extending"] = None
    refused(made, "claim true = {'1': 2}, but it is None")
    made["claims"]["true"] = None
    assert verified(made)["rigid"] == "refuted"
    for mode in support["modes"]:
        mode["extends"] = "undecided"
    made["claims"]["rigid"] = "undecided"
    assert "those of the true motions are not decided" in checker.summary(verified(made))
    support["modes"] = None
    assert verified(made)["true"] is None


# --- the drawing ---------------------------------------------------------------------------------

CORNERS = [(0, 0), (4, 0), (4, 4), (0, 4)]
SIDES = [(0, 1), (1, 2), (2, 3), (0, 3)]


@pytest.mark.parametrize(
    ("points", "edges", "message"),
    [
        ([], [(1, 0), (1, 2), (2, 3), (0, 3)], "1-0 is not an edge"),
        ([(1, 1)], [], "vertex 4 is on no edge"),
        (
            [(1, 1), (2, 1), (1, 2)],
            [(4, 5), (5, 6), (4, 6)],
            "the drawing has 2 outer faces, not one",
        ),
        ([(1, 1)], [(0, 4)], "edge 0-4 has one face on both sides"),
        ([(5, 4), (4, 5)], [(2, 4), (4, 5), (2, 5)], "the boundary passes a vertex twice"),
    ],
)
def test_drawings_that_are_no_sheet(
    points: list[tuple[int, int]], edges: list[tuple[int, int]], message: str
) -> None:
    sides = [] if (1, 0) in edges else SIDES
    stopped(drawn([*CORNERS, *points], [*sides, *edges]), message)


@pytest.mark.parametrize(
    ("points", "edges"),
    [
        ([(0, 0), (4, 0), (0, 4), (2, 0)], [(0, 1), (1, 2), (0, 2), (0, 3), (2, 3)]),
        ([(0, 0), (4, 0), (0, 4), (2, 2), (4, 4)], [(0, 1), (1, 2), (0, 2), (3, 4), (1, 4)]),
    ],
)
def test_edges_that_touch(points: list[tuple[int, int]], edges: list[tuple[int, int]]) -> None:
    with pytest.raises(checker.CertificateError, match=r"edges .* meet"):
        verified(drawn(points, edges))


def test_a_strip_that_turns_until_it_overlaps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each panel is in order, and only the boundary meets itself, in several places."""
    along = [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1)]
    points = [(r * x, r * y) for x, y in along for r in (1, 3)]
    edges = [(2 * k, 2 * k + 1) for k in range(5)]
    edges += [(k, k + 2) for k in range(8)]
    with monkeypatch.context() as patch:
        patch.setattr(panel_sheet.PanelSheet, "_check_apart", lambda _: None)
        forged = matched(drawn(points, edges))
    refused(forged, "edges 6-8 and 0-2 meet")


def test_edges_are_sorted() -> None:
    made = certified("square")
    made["pattern"]["edges"].reverse()
    stopped(made, "the edges are not sorted")


@pytest.mark.parametrize(
    ("radicands", "message"),
    [
        ([["4"]], "radicand 0 is a square"),
        ([["-2"]], "a square root is taken of a number that is not positive"),
        ([["2"], ["3", "2"]], "radicand 1 is a square"),
        (
            [[str(p)] for p in (2, 3, 5, 7, 11, 13, 17)],
            beyond("the square roots of the field", 7, 6, "MOST_ROOTS"),
        ),
    ],
)
def test_fields(radicands: list[list[str]], message: str) -> None:
    made = certified("square")
    size = 1
    made["pattern"]["radicands"] = []
    for radicand in radicands:
        made["pattern"]["radicands"].append(radicand + ["0"] * (size - len(radicand)))
        size *= 2
    for point in made["pattern"]["vertices"]:
        for c in point:
            c += ["0"] * (size - 1)
    stopped(made, message)


# --- supports, modes and components --------------------------------------------------------------


def supports_of(made: Document) -> list[Document]:
    found: list[Document] = made["claims"]["supports"]
    return found


def test_a_support_is_missing() -> None:
    made = certified("two rows")
    lost = supports_of(made).pop()
    where = "-".join(map(str, lost["vertices"]))
    stopped(made, f"the support of vertices {where} is missing")


def test_a_support_too_many() -> None:
    made = certified("two rows")
    more = {**supports_of(made)[0], "folds": [[0, 1]]}
    supports_of(made).append(more)
    stopped(made, "the folds [(0, 1)] are not the folds of a support")


def test_a_support_twice() -> None:
    made = certified("strip")
    [support] = supports_of(made)
    supports_of(made).append(support)
    folds = [tuple(edge) for edge in support["folds"]]
    stopped(made, f"a support with the folds {folds} appears twice")


def test_vertices_and_numbers_of_a_support() -> None:
    made = certified("strip")
    [support] = supports_of(made)
    where = "-".join(map(str, support["vertices"]))
    right = support["vertices"]
    support["vertices"] = right[1:]
    stopped(made, f"vertices of the support of vertices {where}: {right[1:]}, but it is {right}")
    support["vertices"], support["count"] = right, 31
    stopped(made, f"count of the support of vertices {where}: 31, but it is 32")


@pytest.mark.parametrize(
    ("name", "kind", "claims"),
    [
        ("strip", "forest", ("linear", "loops", None)),
        ("crossing", "forest", ("loops",)),
        ("tiling", "loops", ("forest", "linear")),
    ],
)
def test_how_a_support_extends(name: str, kind: str, claims: tuple[str | None, ...]) -> None:
    for claim in claims:
        made = certified(name)
        support = supports_of(made)[0]
        support["by"] = claim
        where = "-".join(map(str, support["vertices"]))
        stopped(made, f"the support of vertices {where} extends by {kind}, not by {claim!a}")


def test_linear_transmissions() -> None:
    made = certified("three rows")
    kinds = [support["by"] for support in supports_of(made)]
    assert kinds.count("linear") == 4
    assert set(kinds) == {"linear", "forest"}


def test_numbers_that_extend() -> None:
    made = certified("strip")
    [support] = supports_of(made)
    where = "-".join(map(str, support["vertices"]))
    support["extending"] = None
    open_number = "extend, but their number is left open"
    stopped(made, f"all modes of the support of vertices {where} {open_number}")
    support["extending"] = 31
    stopped(made, f"32 modes of the support of vertices {where} extend, not 31")
    support["modes"] = None
    refused(made, f"32 modes of the support of vertices {where} extend, not 31")
    support["extending"] = 32
    verified(made)


TILING = "the support of vertices 5-6-9-10"


def test_modes_that_are_listed() -> None:
    made = certified("tiling")
    modes = supports_of(made)[0]["modes"]
    one, other = (dict(mode) for mode in modes)
    del modes[1]
    supports_of(made)[0]["extending"] = 1
    stopped(made, f"the mode {other['choice']} of {TILING} is missing")
    supports_of(made)[0]["extending"] = 2
    modes[:] = [one, other, dict(one)]
    stopped(made, f"the mode {one['choice']} of {TILING} appears twice")
    modes[:] = [one, other, {**one, "choice": "++++"}]
    stopped(made, f"'++++' is not a mode of {TILING}")
    letters = one["assignment"]
    turned = letters.translate(str.maketrans("MV", "VM"))
    modes[:] = [{**one, "assignment": turned}, other]
    verified(made)
    false = letters[:-1] + ("M" if letters[-1] == "V" else "V")
    modes[:] = [{**one, "assignment": false}, other]
    with pytest.raises(checker.CertificateError, match="has the letters"):
        verified(made)


def refutation(made: Document) -> tuple[Document, Document, str]:
    """The mode of the bent zigzags that does not extend, its support, and their name."""
    for support in supports_of(made):
        for mode in support["modes"]:
            if mode["extends"] == "refuted":
                return support, mode, "-".join(map(str, support["vertices"]))
    raise AssertionError


def test_a_mode_that_does_not_extend() -> None:
    made = certified("bent")
    support, mode, where = refutation(made)
    for order in (5, panel_loops.MOST_ORDER):
        mode["order"] = order
        verified(made)
    mode.update(extends="proved", loop=None, order=None)
    support["extending"] = 1
    message = f"a mode of the support of vertices {where} is refuted, not 'proved'"
    refused(made, message)
    support["modes"] = None
    refused(made, f"0 modes of the support of vertices {where} extend, not 1")
    support["extending"] = 0
    verified(made)


@pytest.mark.slow
def test_a_mode_that_extends_is_not_refuted() -> None:
    made = certified("tiling")
    [support] = supports_of(made)
    mode = support["modes"][0]
    support["extending"] = 1
    mode["extends"] = "refuted"
    for loop in ([5, 9, 10, 6], [6, 10, 9, 5]):
        for order in (3, 17):
            mode.update(loop=loop, order=order)
            shown = "-".join(map(str, loop))
            message = f"the loop {shown} of {TILING} is not proved to fail at order {order}"
            stopped(made, message)
    for order in (0, 1, 4, 67):
        mode.update(loop=[5, 9, 10, 6], order=order)
        refused(made, f"there is no order {order}")
    for loop in ([], [5], [5, 9], [5, 9, 6, 10], [5, 9, 10, 6, 5], [0, 1, 5, 4]):
        mode.update(loop=loop, order=3)
        with pytest.raises(checker.CertificateError, match=r"is not a loop of|not proved to fail"):
            verified(made)
    mode.update(extends="refuted", loop=None, order=None)
    refused(made, "a loop is not a list")
    support["extending"] = 2
    mode.update(extends="proved", loop=[5, 9, 10, 6], order=3)
    stopped(made, f"a mode of {TILING} names a loop or an order, but is not refuted")


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("interior", 5),
        ("border", 11),
        ("folds", 13),
        ("sha256", "0" * 64),
        ("flat", [[5, 6]]),
        ("free", [[5, 6]]),
        ("second_order", {"1": 3}),
        ("second_order", {"1": 4, "2": 1}),
        ("second_order", {"1": 3, "2": True}),
        ("second_order", {"1": 3, "2": 1, "3": 0}),
        ("true", {"1": 3, "2": 1}),
        ("true", None),
        ("rigid", "proved"),
        ("modes", 4),
    ],
)
def test_claims(key: str, value: object) -> None:
    made = certified("bent")
    right = made["claims"][key]
    made["claims"][key] = value
    stopped(made, f"claim {key} = {value!a}, but it is {right!a}")


def test_folds_that_are_held() -> None:
    made = certified("crossing", [(5, 6)])
    made["claims"]["held"] = []
    with pytest.raises(checker.CertificateError):
        verified(made)
    made = certified("square")
    made["claims"]["held"] = [[0, 4]]
    stopped(made, "0-4 is held flat, but is not a fold")
    made = certified("square", [(4, 5)])
    made["claims"]["held"] = [[4, 5], [4, 5]]
    stopped(made, "held are not sorted")


# --- limits --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "module", "limit", "value", "what", "known_as"),
    [
        ("strip", panels, "MOST_LISTED", 31, "modes of {}", "MOST_LISTED"),
        ("two rows", panels, "MOST_SUPPORTS", 4, "supports", "MOST_SUPPORTS"),
        (
            "two rows",
            panel_modes,
            "MOST_STEPS",
            27,
            "steps of the search for supports",
            "MODE_STEPS",
        ),
        ("tiling", panel_modes, "MOST_ROWS", 15, "choices of modes round 5-9-10-6", "MODE_ROWS"),
        (
            "tiling",
            panel_modes,
            "MOST_ROOTS",
            0,
            "square roots that the loop 5-9-10-6 needs",
            "MODE_ROOTS",
        ),
        (
            "tiling",
            panel_loops,
            "MOST_BENT",
            3,
            "transmissions of the loop 5-9-10-6 that are not linear",
            "MOST_BENT",
        ),
        ("strip", panel_modes, "MOST_ROWS", 31, "rows of {}", "MODE_ROWS"),
        ("two rows", panel_components, "MOST_SETS", 5, "steps to the components", "MOST_SETS"),
    ],
)
def test_limits(
    name: str,
    module: object,
    limit: str,
    value: int,
    what: str,
    known_as: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = certified(name)
    where = "-".join(map(str, supports_of(made)[0]["vertices"]))
    asked = f"the {what}".format(f"the support of vertices {where}")
    monkeypatch.setattr(module, limit, value)
    stopped(made, beyond(asked, value + 1, value, known_as))
    monkeypatch.setattr(module, limit, value + 1)
    verified(made)


def test_reading() -> None:
    made = certified("square")
    with pytest.raises(checker.FormatError, match="the kind 'sheets' is not known"):
        checker.load(json.dumps({**made, "kind": "sheets"}))
    with pytest.raises(checker.FormatError, match="expected an object with the keys"):
        checker.load(json.dumps({**made, "more": 1}))
    for place in ("pattern", "claims"):
        with pytest.raises(checker.CertificateError, match="expected an object with the keys"):
            verified({**made, place: {**made[place], "more": 1}})
    made["pattern"]["vertices"] = 7
    refused(made, "vertices is not a list")


def test_what_nothing_else_refuses_is_malformed() -> None:
    made = certified("strip")
    supports_of(made)[0]["modes"][0]["choice"] = []
    refused(made, "malformed: TypeError while checking")


@pytest.mark.parametrize("name", ["tiling", "bent", "strip"])
def test_transmissions_close_the_vertices(name: str) -> None:
    """Round a vertex the product of the quaternions 1 + tau d has no vector part."""
    sheet, _ = panel_sheet.read_panels(certified(name)["pattern"])
    modes = panel_modes.Modes(sheet, sheet.live([]))
    loops = panel_loops.Loops(modes)
    zero, one = (Interval.of(Fraction(n), BITS) for n in (0, 1))
    bent = 0
    for v, near in modes.near.items():
        for line, found in enumerate(modes.lines[v]):
            for start in found.densities:
                product = (1.0, 0.0, 0.0, 0.0)
                for u in near:
                    tau = 0.0
                    if u in found.densities:
                        step = loops.step(v, line, start, u) if u != start else None
                        series = (
                            [one]
                            if step is None
                            else panel_loops.composed(
                                [step], 33, lambda _, value: value.enclosed(BITS), zero, one
                            )
                        )
                        bent += step is not None and step.quadratic is not None
                        tau = sum(middle(c) * 0.004 ** (2 * n + 1) for n, c in enumerate(series))
                    x, y = (tau * middle(c.enclosed(BITS)) for c in sheet.vector(v, u))
                    product = times(product, (1.0, x, y, 0.0))
                assert max(map(abs, product[1:])) < 1e-13
    assert bent > 10


def middle(found: Interval) -> float:
    """The middle of an interval, in floating point."""
    return float(Fraction(found.low + found.high, 2 << BITS))


def times(a: tuple[float, ...], b: tuple[float, ...]) -> tuple[float, float, float, float]:
    """The product of two quaternions."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


def test_matched_changes_facts_only() -> None:
    made = certified("bent")
    assert matched(made) == made


def test_a_free_fold_is_in_every_component() -> None:
    sheet = grid(2, 2, lambda i, j: (i, j))
    assert verified(certificate_of_panels(decompose(sheet)))["second_order"] == {"1": 2}


def test_what_lies_on_no_loop_does_not_say_how_a_mode_extends() -> None:
    """Two loops joined by folds, with a transmission between them that is not linear."""
    result = decompose(joined_twists())
    assert result.true == {1: 6 * 2 * 6}
    made = certificate_of_panels(result)
    [support] = supports_of(made)
    assert (support["by"], support["extending"]) == ("linear", 72)
    assert verified(made)["true"] == {"1": 72}
    where = "-".join(map(str, support["vertices"]))
    support["by"] = "loops"
    stopped(made, f"the support of vertices {where} extends by linear, not by 'loops'")
