"""The certificate of a decomposition: the exact pattern and every claim of a proved result."""

from __future__ import annotations

import platform
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.certificates.entries import Document, box_entry
from exactfold.checker.panels.certificate import PANELS
from exactfold.checker.panels.claims import (
    IsolatedClaim,
    LeafClaim,
    ModeClaim,
    PanelsClaims,
    PartClaim,
    SupportClaim,
    TreeClaim,
)
from exactfold.errors import NotApplicableError, TooManyModesError
from exactfold.panels.counts import Counts
from exactfold.panels.decomposition import MOST_LISTED
from exactfold.panels.isolated import IsolatedWays
from exactfold.panels.modes.elementary import ModeSearch, Support
from exactfold.panels.modes.extension import FOREST, Loops, extension
from exactfold.panels.result import Decomposition, Mode, Part
from exactfold.panels.vertex.holes import conditions
from exactfold.panels.vertex.local import LocalMode, local_modes
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import Edge, PanelPattern


def certificate_of_panels(result: Decomposition) -> Document:
    """The certificate of a complete decomposition, as a JSON object for `exactfold.checker`.

    It contains the pattern and the claims (docs/certificate.md, Panels). The checker computes all
    the claims again. Raises `NotApplicableError` if the decomposition is not proved.

    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> square = PanelPattern([(0, 0), (1, 0), (1, 1), (0, 1)],
    ...                       [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
    >>> certificate_of_panels(decompose(square))["claims"]["second_order"]
    {'1': 1}
    """
    if result.graphs is not None:
        raise NotApplicableError(
            "the number of families rests on Theorem 6 (docs/any_border.md) and needs none"
        )
    if result.status is not PROVED or result.second_order is None:
        raise NotApplicableError(
            f"only a proved decomposition has a certificate; this one is {result.status} "
            f"({result.reason})"
        )
    pattern = result.pattern
    moving = conditions(pattern, result.held)
    listed: dict[tuple[Edge, ...], list[Mode]] = {}
    for mode in result.modes:
        listed.setdefault(tuple(sorted(mode.assignment)), []).append(mode)
    supports = [
        _support(pattern, moving, together, listed.get(together.folds))
        for part in result.parts
        if part.theory == "modes" and not part.by_tree
        for together in _by_folds(pattern, {v: moving[v] for v in part.vertices}, part.supports)
    ]
    listed_parts = [part for part in result.parts if part.theory == "subspaces"]
    spaces = [_spaces(part) for part in listed_parts if not part.by_tree]
    trees: list[TreeClaim] = [
        {"vertices": list(part.vertices), "components": _counts(part.second_order or {})}
        for part in result.parts
        if part.by_tree
    ]
    claims: PanelsClaims = {
        "interior": len(pattern.interior),
        "border": len(pattern.boundary_set),
        "folds": len(pattern.folds),
        "sha256": pattern.sha256,
        "held": _pairs(result.held),
        "flat": _pairs(result.flat),
        "free": _pairs(result.free),
        "second_order": _counts(result.second_order),
        "true": None if result.true is None else _counts(result.true),
        "rigid": str(result.rigid),
        "modes": result.modes_count,
        "supports": supports,
    }
    if spaces:
        claims["spaces"] = spaces
    if trees:
        claims["trees"] = trees
    return {
        "format": PANELS.format,
        "version": PANELS.version,
        "kind": PANELS.named,
        "pattern": panels_document(pattern),
        "claims": claims,
        "provenance": {"method": result.theory, "python": platform.python_version()},
    }


def _spaces(part: Part) -> PartClaim:
    """The leaves of a part, grouped by folds, dimension and cones, with the number that fold."""
    kinds: dict[tuple[tuple[Edge, ...], int, tuple[int, ...]], list[bool]] = {}
    for leaf, folds in zip(part.spaces, part.spaces_fold, strict=True):
        kinds.setdefault((leaf.folds, leaf.dimension, leaf.vertices), []).append(folds)
    leaves: list[LeafClaim] = [
        {
            "folds": _pairs(folds),
            "dimension": dimension,
            "cones": list(cones),
            "number": len(each),
            "extending": sum(each),
        }
        for (folds, dimension, cones), each in kinds.items()
    ]
    claim: PartClaim = {
        "vertices": list(part.vertices),
        "complete": part.true is not None,
        "leaves": leaves,
    }
    if part.isolated is not None:
        claim["isolated"] = _isolated(part.isolated)
    return claim


def _isolated(ways: IsolatedWays) -> IsolatedClaim:
    """All complex motions of a part; of two conjugate motions only one is written."""
    return {
        "chart": [[*fold, weight] for fold, weight in zip(ways.folds, ways.chart, strict=True)],
        "real": [box_entry(box) for box in ways.real],
        "nonreal": [box_entry(box) for box in ways.nonreal],
    }


@dataclass(frozen=True)
class _Together:
    """Folds that move together, and the number of ways in which they do; a part of a `Support`."""

    vertices: tuple[int, ...]
    folds: tuple[Edge, ...]
    count: int
    choices: tuple[tuple[LocalMode, ...], ...]  # all of them, or one if they are too many


def _by_folds(
    pattern: PanelPattern, moving: Mapping[int, Star], supports: Iterable[Support]
) -> Iterator[_Together]:
    """The supports, split by their active folds.

    Most supports have a single set of active folds; crossing straight creases give several.
    """
    search = ModeSearch(moving, pattern.field)
    for support in supports:
        kinds = [{mode.folds for mode in search.modes[v]} for v in support.vertices]
        if support.count > MOST_LISTED:
            if any(len(kind) > 1 for kind in kinds):
                raise NotApplicableError(
                    f"no certificate: it would have to list {support.count} modes of different "
                    f"folds round vertex {support.vertices[0]}; at most {MOST_LISTED} are listed"
                )
            folds = {edge for [active] in kinds for edge in active}
            yield _Together(
                support.vertices, tuple(sorted(folds)), support.count, (support.example,)
            )
            continue
        groups: dict[tuple[Edge, ...], list[tuple[LocalMode, ...]]] = {}
        try:
            modes = search.listed(support)
        except TooManyModesError as error:
            raise NotApplicableError(
                f"no certificate, because it would have to list all modes: {error}"
            ) from None
        for mode in modes:
            groups.setdefault(tuple(mode.densities), []).append(mode.choice)
        for edges, choices in sorted(groups.items()):
            yield _Together(support.vertices, edges, len(choices), tuple(choices))


def _support(
    pattern: PanelPattern,
    moving: Mapping[int, Star],
    together: _Together,
    listed: list[Mode] | None,
) -> SupportClaim:
    """A support with the number of its modes that truly fold, and with the modes if they are
    listed.
    """
    first = extension(pattern, moving, together.choices[0])
    by, extending = "loops", None
    if first.verdict is PROVED and not first.order:
        by = "forest" if first.by == FOREST else "linear"
        extending = together.count
    elif len(together.choices) == together.count:
        loops: Loops = {}
        verdicts = [extension(pattern, moving, c, loops).verdict for c in together.choices]
        extending = None if UNDECIDED in verdicts else verdicts.count(PROVED)
    return {
        "vertices": list(together.vertices),
        "folds": _pairs(together.folds),
        "count": together.count,
        "extending": extending,
        "by": by,
        "modes": None if listed is None else [_mode(mode, together, moving) for mode in listed],
    }


def _mode(mode: Mode, together: _Together, moving: Mapping[int, Star]) -> ModeClaim:
    verdict = mode.extends.verdict
    refuted = verdict is REFUTED
    return {
        "choice": choice_text(mode.choice, moving),
        "assignment": "".join(mode.assignment[edge] for edge in together.folds),
        "extends": str(verdict),
        "loop": list(mode.extends.cycle) if refuted else None,
        "order": mode.extends.order if refuted else None,
    }


def choice_text(choice: Iterable[LocalMode], moving: Mapping[int, Star]) -> str:
    """The name of a mode in a certificate: its line at each vertex, "0" if there is only one."""
    return "".join(_line(local, moving[local.vertex]) for local in choice)


def _line(local: LocalMode, star: Star) -> str:
    """Which of the local modes with the same active folds this is, by the gain of the first two
    folds.
    """
    first, second = sorted(local.folds, key=lambda edge: sum(edge) - local.vertex)[:2]
    gains = [mode.gain(first, second) for mode in local_modes(star) if mode.folds == local.folds]
    if len(gains) == 1:
        return "0"
    return "-" if local.gain(first, second) == min(gains) else "+"


def _counts(counts: Counts) -> dict[str, int]:
    return {str(dimension): number for dimension, number in sorted(counts.items())}


def _pairs(edges: Iterable[Edge]) -> list[list[int]]:
    return [[i, j] for i, j in edges]
