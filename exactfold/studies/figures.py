"""Draws the paper's computed figures again, from proved branches.

A row is a figure or a part of one: the numbers that it shows. The size of a row is the number of
its figure.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.collect import count_branches
from exactfold.motion.following import follow
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import single_vertex, two_vertex
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import vertex_sign_functional
from exactfold.studies.running.lines import Lines
from exactfold.studies.running.study import Recipe, Row, Study, StudyFigure, StudyTable
from exactfold.studies.table1 import same_side

SHOWN: Final = {
    1: "branches in the space of fold angles",
    2: "cone of a vertex with five folds",
    3: "chambers of vertex signs",
    4: "branches with equal letters",
    5: "branches with equal letters and vertex signs",
}
"""The subject of each figure, by number."""

_SQUARES: Final = {4: 50001261, 5: 50000527}
"""The seeds of random squares with five vertices and with branches that share their letters."""

_FOLDS: Final = ((0, 4), (1, 4), (1, 5))
"""The folds of the two-vertex pattern whose angles are the axes."""

_AXES: Final = {2: (3, 4, 5), 3: (3, 4, 5)}
"""The vertices whose heights are the axes; vertices 0, 1 and 2 are held at height 0."""

_ARROW: Final = 48.0
"""The length of the arrows of angles, in degrees."""

_MOUNTAIN, _VALLEY = "#c62828", "#1565c0"
_RAYS: Final = ("#365c8d", "#1fa187", "#e07b39", "#7b3294")


def recipes(seed: int, numbers: Mapping[int, int]) -> Iterator[Recipe]:
    """Yields each figure once; `seed` changes nothing.

    >>> [recipe["figure"] for recipe in recipes(0, {1: 1, 4: 1})]
    [1, 4]
    """
    return ({"figure": figure} for figure, number in numbers.items() if number)


def row(recipe: Recipe) -> dict[str, Any]:
    """The numbers of a figure, with six digits; proved if the branches that it shows are."""
    figure = int(recipe["figure"])
    if figure == 1:
        return _curves()
    if figure in _AXES:
        return _heights(single_vertex(5) if figure == 2 else two_vertex(), _AXES[figure])
    return _shared(figure)


def _rounded(values: Any) -> Any:
    return np.round(np.asarray(values, dtype=float), 6).tolist()


def _curves() -> dict[str, Any]:
    """The angles of three folds, in degrees, along both rays of each branch as the sheet folds."""
    count = count_branches(two_vertex())
    folds = [count.pattern.folds.index(fold) for fold in _FOLDS]
    curves = []
    for branch in count.branches:
        for side in (1, -1):
            motion = follow(branch, side=side, until="45deg", frames=24)
            angles = np.degrees(motion.angles[:, folds])
            curves.append({"signs": branch.sign_text, "side": side, "angles": _rounded(angles)})
    return {"status": str(count.status), "folds": [list(f) for f in _FOLDS], "curves": curves}


def _heights(pattern: CreasePattern, axes: tuple[int, ...]) -> dict[str, Any]:
    """The forms and sign functionals in the heights of three vertices, and the branches."""
    forms = {}
    for v in pattern.interior:
        form = curvature_form(pattern, v)
        place = {label: k for k, label in enumerate(form.labels)}
        forms[v] = [
            [form.matrix[place[i]][place[j]] if {i, j} <= place.keys() else 0 for j in axes]
            for i in axes
        ]
    signs = {v: vertex_sign_functional(pattern, v) for v in pattern.interior}
    count = count_branches(pattern)
    rays = [
        {
            "signs": branch.sign_text,
            "heights": _rounded(_above(pattern, branch.approx_heights)[list(axes)]),
        }
        for branch in count.branches
    ]
    return {
        "status": str(PROVED if count.status is PROVED else UNDECIDED),
        "axes": list(axes),
        "forms": {str(v): _rounded(matrix) for v, matrix in forms.items()},
        "functionals": {
            str(v): _rounded(_unit(np.array([float(row.get(i, 0)) for i in axes])))
            for v, row in signs.items()
        },
        "rays": rays,
    }


def _unit(vector: FloatArray) -> FloatArray:
    unit_vector: FloatArray = vector / np.linalg.norm(vector)
    return unit_vector


def _above(pattern: CreasePattern, heights: Mapping[int, Any]) -> FloatArray:
    """The heights above the plane of vertices 0, 1 and 2."""
    points = np.array([[float(x), float(y), 1.0] for x, y in pattern.vertices])
    values = np.array([float(heights[v]) for v in range(len(points))])
    above: FloatArray = values - points @ np.linalg.solve(points[:3], values[:3])
    return above


def _shared(figure: int) -> dict[str, Any]:
    """A random square, and its first branches that share their letters (and signs)."""
    pattern = random_square(5, _SQUARES[figure])
    lines = Lines.of(pattern)
    if lines.status is not PROVED:
        return {"status": str(lines.status), "seed": _SQUARES[figure]}
    letters, signs = same_side(lines.letters, lines.signs)
    kinds = letters if figure == 4 else np.hstack([letters, signs])
    _, index, counts = np.unique(kinds, axis=0, return_inverse=True, return_counts=True)
    pair = np.flatnonzero(index.ravel() == int(np.flatnonzero(counts > 1)[0]))[:2]
    return {
        "status": str(lines.status),
        "seed": _SQUARES[figure],
        "vertices": _rounded([[float(x), float(y)] for x, y in pattern.vertices]),
        "folds": [list(fold) for fold in pattern.folds],
        "boundary": list(pattern.boundary),
        "interior": list(pattern.interior),
        "letters": letters[pair[0]].tolist(),
        "signs": signs[pair].tolist(),
        "branches": len(lines.signs),
    }


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """A table of what each figure shows."""
    lines = []
    for row in sorted(rows, key=lambda row: int(row["figure"])):
        figure = int(row["figure"])
        if not _has_picture(row):
            about = ""
        elif figure == 1:
            about = f"{len(row['curves'])} motions of the two-vertex pattern"
        elif figure in _AXES:
            about = f"{len(row['rays'])} branches" if figure == 3 else "two nappes, a plane each"
        else:
            first, second = row["signs"]
            differing = [
                str(v) for v, a, b in zip(row["interior"], first, second, strict=True) if a != b
            ]
            same = "all vertex signs agree"
            about = f"seed {row['seed']}: " + (
                f"the signs of {', '.join(differing)} differ" if differing else same
            )
        lines.append((figure, SHOWN[figure], about, str(row["status"])))
    return [
        StudyTable(
            "figures",
            "Figures of the paper, drawn again",
            ("", "figure", "shows", "status"),
            tuple(lines),
        )
    ]


def _has_picture(row: Row) -> bool:
    """Whether everything that the picture shows is proved."""
    return bool(row["status"] == str(PROVED))


def _view(turn: float, lift: float) -> FloatArray:
    """An orthographic view from the direction of two angles in degrees, as a 2 x 3 matrix."""
    a, b = np.radians([turn, lift])
    return np.array(
        [
            [-np.sin(a), np.cos(a), 0.0],
            [-np.cos(a) * np.sin(b), -np.sin(a) * np.sin(b), np.cos(b)],
        ]
    )


def _axes_of_space(
    axes: Any,
    view: FloatArray,
    names: Sequence[str],
    size: float,
    anchors: Sequence[tuple[str, str]],
) -> None:
    """Three arrows from the origin with names; `anchors` places the names at the tips."""
    for direction, name, (across, along) in zip(np.eye(3), names, anchors, strict=True):
        x, y = view @ direction * size
        axes.plot([1.25 * x], [1.25 * y], alpha=0.0)  # makes room for the name
        axes.annotate(
            "", (x, y), (0, 0), arrowprops={"arrowstyle": "->", "color": "0.55", "lw": 0.7}
        )
        axes.text(
            1.05 * x,
            1.05 * y,
            name,
            ha=across,
            va=along,
            fontsize=8,
            color="0.25",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.8},
        )
    axes.set_aspect("equal")
    axes.axis("off")


def _draw_curves(axes: Any, row: Row) -> None:
    view = _view(112.0, 15.0)
    names = [f"angle\nof {i}–{j}" for i, j in row["folds"]]
    for place, curve in enumerate(row["curves"]):
        points = np.array(curve["angles"]) @ view.T
        colour = _RAYS[place // 2]
        axes.plot(points[:, 0], points[:, 1], color=colour)
        if curve["side"] > 0:
            x, y = points[-1] * (1 + 4 / np.linalg.norm(points[-1]))
            axes.text(x, y, _shown(curve["signs"]), ha="center", va="center", color=colour)
    anchors = (("right", "center"), ("center", "top"), ("center", "bottom"))
    _axes_of_space(axes, view, names, _ARROW, anchors)
    axes.plot([0], [0], "o", color="black", markersize=4)
    _draw_inset(axes.inset_axes([0.0, 0.0, 0.3, 0.3]), row["folds"])


def _draw_inset(axes: Any, shown: Sequence[Sequence[int]]) -> None:
    """Draws the two-vertex pattern; the folds `shown` are thick."""
    pattern = two_vertex()
    points = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    middle = points.mean(axis=0)
    for i, j in pattern.edges:
        width = 1.8 if [i, j] in [list(fold) for fold in shown] else 0.6
        axes.plot(points[[i, j], 0], points[[i, j], 1], color="0.25", linewidth=width)
    reach = 0.13 * float(np.ptp(points))
    for v, point in enumerate(points):
        away = point - middle
        x, y = point + reach * away / np.linalg.norm(away) if v in pattern.boundary else point
        if v not in pattern.boundary:
            y += 0.8 * reach
        axes.text(x, y, str(v), ha="center", va="center", fontsize=7, color="0.35")
    axes.margins(0.2)
    axes.set_aspect("equal")
    axes.axis("off")


def _shown(signs: str) -> str:
    """Vertex signs with a minus sign that is as wide as the plus sign."""
    return signs.replace("-", "\N{MINUS SIGN}")


def _draw_cone(axes: Any, row: Row) -> None:
    view = _view(35.0, 20.0)
    (form,) = (np.array(form) for form in row["forms"].values())
    (up,) = (np.array(functional) for functional in row["functionals"].values())
    values, vectors = np.linalg.eigh(form)
    turns = np.linspace(0, 2 * np.pi, 121)
    circle = vectors[:, 2:] / np.sqrt(values[2]) + (
        vectors[:, :1] * np.cos(turns) / np.sqrt(-values[0])
        + vectors[:, 1:2] * np.sin(turns) / np.sqrt(-values[1])
    )
    circle *= np.sign(up @ vectors[:, 2]) / np.linalg.norm(circle, axis=0)
    for side, colour, label in ((1, _RAYS[2], "up"), (-1, _RAYS[0], "down")):
        rim = side * (view @ circle)
        for k in range(0, 120, 4):
            axes.plot([0, rim[0, k]], [0, rim[1, k]], color=colour, lw=0.5, alpha=0.6)
        axes.plot(rim[0], rim[1], color=colour)
        x, y = rim[:, int(rim[0].argmax())]
        axes.text(x, y + 0.2 * side, f"popped {label}", color=colour, ha="right", va="center")
    anchors = (("right", "top"), ("left", "center"), ("center", "bottom"))
    _axes_of_space(axes, view, [f"$h_{v}$" for v in row["axes"]], 1.1, anchors)


def _draw_chambers(axes: Any, row: Row) -> None:
    """Draws the chambers in coordinates whose planes are the planes of the vertex signs."""
    view = _view(36.0, 24.0)
    coordinates = np.array([*row["functionals"].values(), [1.0, 0.0, 0.0]])
    rays = np.array([ray["heights"] for ray in row["rays"]]) @ coordinates.T
    rays /= np.abs(rays).max(axis=0)
    square = 0.9 * np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]])
    for place, shade in ((0, "0.72"), (1, "0.5")):
        corners = np.insert(square, place, 0.0, axis=1) @ view.T
        axes.fill(corners[:, 0], corners[:, 1], color=shade, alpha=0.3, lw=0)
    for place, ray in enumerate(rays):
        x, y = view @ ray
        axes.plot([-x, x], [-y, y], color=_RAYS[place])
        signs = _shown(row["rays"][place]["signs"])
        axes.text(1.12 * x, 1.12 * y, signs, ha="center", va="center", color=_RAYS[place])
    names = [f"vertex {v} up" for v in row["functionals"]]
    anchors = (("right", "center"), ("left", "bottom"), ("center", "bottom"))
    _axes_of_space(axes, view, [*names, f"$h_{row['axes'][0]}$"], 1.15, anchors)


def _draw_shared(axes: Any, row: Row) -> None:
    points = np.array(row["vertices"])
    rim = [*row["boundary"], row["boundary"][0]]
    axes.plot(points[rim, 0], points[rim, 1], color="black")
    for (i, j), letter in zip(row["folds"], row["letters"], strict=True):
        colour, style = (_VALLEY, (0, (4, 2))) if letter > 0 else (_MOUNTAIN, "-")
        axes.plot(points[[i, j], 0], points[[i, j], 1], color=colour, linestyle=style)
    for v, one, other in zip(row["interior"], *row["signs"], strict=True):
        both = {1: "white", -1: "black"}[one] if one == other else "#f6c700"
        axes.plot(
            *points[v], "o", markersize=6, markerfacecolor=both, markeredgecolor="black", zorder=3
        )
        axes.annotate(
            str(v), points[v], (7, 4), textcoords="offset points", fontsize=7, color="0.25"
        ).set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.3})
    axes.set_aspect("equal")
    axes.axis("off")


_LEGEND = (
    "Mountains are red, valleys blue and dashed. White vertices pop up in both branches, black "
    "ones down, yellow ones up in one and down in the other."
)


def figures(rows: Iterable[Row]) -> list[StudyFigure]:
    """One figure for each row."""
    drawn = {
        1: ("branches", "Fig. 1: branches near the flat state", _draw_curves),
        2: ("cone", "The cone of a vertex with five folds", _draw_cone),
        3: ("chambers", "The chambers of vertex signs", _draw_chambers),
        4: ("letters", "Two branches with these letters", _draw_shared),
        5: ("signs", "Two branches with these letters and signs", _draw_shared),
    }
    captions = {
        1: "The axes are the angles of three folds of the two-vertex pattern, which are thick in "
        "the inset. The curves are the true motions along its four branches, until a fold has 45 "
        "degrees. Arrows are 48 degrees long, valleys are positive, and the signs are those of "
        "vertices 4 and 5.",
        2: "The cone is the second-order cone in the heights of three vertices; the other three "
        "are held.",
        3: "The lines are the branches of the two-vertex pattern to second order. Two axes show "
        "the functionals of the vertex signs, which vanish on the planes; the third shows the "
        "height of a corner.",
        4: _LEGEND,
        5: _LEGEND,
    }
    study_figures = []
    for row in filter(_has_picture, sorted(rows, key=lambda row: int(row["figure"]))):
        figure = int(row["figure"])
        name, title, draw = drawn[figure]

        def drawing(axes: Any, draw: Any = draw, row: Row = row) -> None:
            draw(axes, row)

        study_figures.append(
            StudyFigure(name, title, captions[figure], drawing, width=3.6, height=3.4)
        )
    return study_figures


STUDY: Final = Study(
    "figures",
    "The paper's computed figures, drawn again from proved branches",
    1,
    dict.fromkeys(SHOWN, 1),
    {},
    recipes,
    row,
    tables,
    figures,
)
