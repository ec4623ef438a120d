"""The motion of panels that a certificate is about, and its fold angles.

For each vertex with active folds the file gives the densities of these folds: angle / length, to
first order. Let tau = tan(angle / 2) / length. A vertex closes if and only if the vector part of
the product of the quaternions 1 + tau_j d_j is 0. If it is 0 for tau = T w and all T, at all
vertices of a mode, the mode folds in this way until all its folds are closed. If the vertices of a
mode have at most four active folds and its transmissions close all loops, the mode folds until its
first fold is closed (docs/motion.md, 18 and 19).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...core.intervals import Interval
from ...core.reading import items, keys, natural, parse_rational, require
from ...core.towers import Number, Tower
from ...panels.lines import Line
from ...panels.loops import Loops
from ...panels.modes import Modes, loops_of, name
from ...sheets.panels import Edge, Near, PanelSheet, cross, dot, pair
from .series import BITS, ONE, Series, thin

_POINT = Interval(ONE, ONE, BITS)
_Pair = tuple[Series, Series]
_Step = tuple[Interval, tuple[Interval, ...] | None]


class Mode:
    """Folds that move together: the folds at the vertices `near`, or one between boundary vertices.

    `linear` says whether all its vertices close for tau = T w and all T. `way` lists the vertices
    in an order in which fold angles can be computed, each with a neighbour: the fold between the
    two is known when the vertex is reached.
    """

    def __init__(self, driver: Edge, near: Near, linear: bool) -> None:
        self.driver, self.near, self.linear = driver, near, linear
        self.way: list[tuple[int, int]] = []
        seen, waiting = set[int](), [driver, driver[::-1]]
        for u, v in waiting:
            if v in near and v not in seen:
                seen.add(v)
                self.way.append((v, u))
                waiting += [(v, w) for w in near[v] if w != u]

    @property
    def folds(self) -> set[Edge]:
        """All folds of the mode."""
        return {self.driver} | {pair(v, u) for v, around in self.near.items() for u in around}


class DrivenModes:
    """The verified modes that fold; the angles of the drivers determine all their fold angles."""

    def __init__(self, sheet: PanelSheet, letters: Any, drivers: Any, vertices: Any) -> None:
        self.sheet = sheet
        self.letters = _letters(sheet, letters)
        active = [edge for edge, letter in self.letters.items() if letter != "F"]
        require(active, "no fold is active")
        inner = set(sheet.interior)
        near: Near = {v: [] for edge in active for v in edge if v in inner}
        for v in near:
            near[v] = [u for u in sheet.around[v] if self.letters.get(pair(v, u), "F") != "F"]
        self._modes = Modes(sheet, {})
        self._modes.near = near
        self._modes.lines = {v: [line] for v, line in self._lines(near, vertices).items()}
        self._loops = Loops(self._modes)
        self._chosen = dict.fromkeys(near, 0)
        self.modes = self._driven(near, active, _edges(drivers))
        self._lengths = {edge: length(sheet, *edge) for edge in active}
        self._steps: dict[tuple[int, int, int], _Step] = {}

    @property
    def active(self) -> set[Edge]:
        """All folds that move."""
        return {fold for mode in self.modes for fold in mode.folds}

    # --- what is verified ------------------------------------------------------------------------

    def _lines(self, near: Near, given: Any) -> dict[int, Line]:
        lines: dict[int, Line] = {}
        chosen = []
        for entry in items(given, "vertices"):
            keys(entry, "vertex radicand densities", "a vertex")
            chosen.append(natural(entry["vertex"], "vertex"))
        message = "the vertices with densities are not those with active folds, each once"
        require(sorted(chosen) == sorted(near), message)
        for v, entry in zip(chosen, given, strict=True):
            tower, radicand = self.sheet.tower, None
            if entry["radicand"] is not None:
                radicand = _number(tower, entry["radicand"])
                tower, _ = tower.adjoined(radicand)
            densities: dict[int, Number] = {}
            for value in items(entry["densities"], "densities"):
                u, parts = items(value, "a density", 2)
                densities[natural(u, "vertex")] = _number(tower, parts)
            same = densities.keys() == set(near[v])
            require(same, f"the densities at {v} are not those of its active folds")
            turns = {
                densities[u].sign() * (1 if self.letters[pair(v, u)] == "V" else -1)
                for u in near[v]
            }
            agree = len(turns) == 1 and 0 not in turns
            require(agree, f"the densities at {v} do not have the signs of the letters")
            lines[v] = Line(densities, radicand)
        return lines

    def _driven(self, near: Near, active: list[Edge], drivers: list[Edge]) -> list[Mode]:
        """The verified modes, each with its one driver."""
        modes, left = [], set(active)
        for driver in drivers:
            free = driver in left
            require(free, f"the driver {driver} is not active, or another driver moves it already")
            part: Near = {}
            waiting = [v for v in driver if v in near]
            while waiting:
                v = waiting.pop()
                if v not in part:
                    part[v] = near[v]
                    waiting += [u for u in near[v] if u in near]
            mode = Mode(driver, dict(sorted(part.items())), all(map(self._closes, part)))
            left -= mode.folds
            self._verify(mode)
            modes.append(mode)
        require(not left, f"no driver moves the fold {sorted(left)[:1]}")
        return modes

    def _verify(self, mode: Mode) -> None:
        """Refuse a mode that is not proved to fold."""
        if not mode.linear:
            for v in mode.near:
                self._verify_line(v)
        for loop in loops_of(self.sheet, mode.near):
            require(self._modes.closes(loop, self._chosen), f"the loop {name(loop)} does not close")
            folds = mode.linear or self._loops.closes(self._chosen, loop)
            require(folds, f"the loop {name(loop)} does not stay closed")

    def _closes(self, v: int) -> bool:
        """Whether a vertex closes for tau = T w and all T."""
        densities = self._modes.lines[v][0].densities
        zero = next(iter(densities.values())).tower.number(0)
        one = zero.tower.number(1)
        whole = [[one, zero, zero, zero]]
        for u in self._modes.near[v]:
            x, y = self.sheet.vector(v, u)
            p, q = densities[u] * x, densities[u] * y
            turned = [
                [-(a * p) - b * q, s * p - c * q, s * q + c * p, a * q - b * p]
                for s, a, b, c in whole
            ]
            none = [zero] * 4
            rows = zip([*whole, none], [none, *turned], strict=True)
            whole = [[k + m for k, m in zip(low, high, strict=True)] for low, high in rows]
        return not any(part.sign() for row in whole for part in row[1:])

    def _verify_line(self, v: int) -> None:
        """Refuse a vertex unless its densities are a line of motions with known transmissions."""
        near, densities = self._modes.near[v], self._modes.lines[v][0].densities
        if len(near) == 2 and self._closes(v):
            return
        require(len(near) == 4, f"vertex {v} does not close, and does not have four active folds")
        # All sectors are less than pi, since otherwise the form is definite (docs/panels.md, 1).
        d = [self.sheet.vector(v, u) for u in near]
        w = [densities[u] for u in near]
        zero = w[0].tower.number(0)
        sums = [sum((a * b[k] for a, b in zip(w, d, strict=True)), zero) for k in (0, 1)]
        sums.append(
            sum((w[k] * w[j] * cross(d[k], d[j]) for j in range(4) for k in range(j)), zero)
        )
        moves = not any(s.sign() for s in sums)
        require(moves, f"the densities at {v} are not those of a motion to second order")

    # --- fold angles -----------------------------------------------------------------------------

    def tangents(self, driven: Callable[[Edge], _Pair]) -> dict[Edge, _Pair]:
        """For each active fold a pair (C, S) with S / C = tan(angle / 2).

        `driven` gives the pairs of the drivers. Raises `ZeroDivisionError` if the pairs are not
        certain, because a fold of a mode that is not linear may be closed.
        """
        pairs: dict[Edge, _Pair] = {}
        for mode in self.modes:
            c, s = driven(mode.driver)
            start = s if self.letters[mode.driver] == "V" else Series([]) - s
            taus = {mode.driver: (c, start.times(_POINT / self._lengths[mode.driver]))}
            for v, u in mode.way:
                known = taus[pair(u, v)]
                for w in mode.near[v]:
                    if pair(v, w) not in taus:
                        taus[pair(v, w)] = self._passed(mode, known, v, u, w)
            if not mode.linear and any(map(may_be_closed, taus.values())):
                raise ZeroDivisionError("a fold may be closed")
            for fold, (below, above) in taus.items():
                pairs[fold] = below, above.times(self._lengths[fold])
        return pairs

    def _passed(self, mode: Mode, known: _Pair, v: int, start: int, end: int) -> _Pair:
        """The pair of one fold at a vertex, computed from the pair of another fold.

        If tau = N / C at the known fold, the other has tau = N u / C, where
        (p + q tau^2) u^2 + b u + a = 0. So u = C z with A z^2 + b C z + a = 0 and
        A = p C^2 + q N^2, and the other tau is N z.
        """
        c, n = known
        gain, quadratic = self._step(mode, v, start, end)
        if quadratic is None:
            return c, n.times(gain)
        p, q, b = quadratic
        # Of the two roots, take the one that equals the gain where the fold is flat.
        side = (p * gain + p * gain + b).sign()
        last = -(gain * (p * gain + b))
        twice = last + last
        leading = (c * c).times(p) + (n * n).times(q)
        root = ((c * c).times(b * b) - leading.times(twice + twice)).root()
        middle = c.times(b)
        root = root if side > 0 else Series([]) - root
        if b.sign() * side >= 0:
            below, above, turn = middle + root, n.times(-twice), side
        else:
            below, above, turn = leading + leading, n * (root - middle), p.sign()
        unit = 1 << 2 * BITS - abs(below.coefficients[0].high).bit_length()
        factor = Interval(turn * unit, turn * unit, BITS)
        return below.times(factor), above.times(factor)

    def _step(self, mode: Mode, v: int, start: int, end: int) -> _Step:
        """The gain from one fold at a vertex to another, and (p, q, b), None if it is linear."""
        key = (v, start, end)
        if key not in self._steps:
            if mode.linear:
                self._steps[key] = thin(self._modes.gain(v, 0, start, end)), None
            else:
                step = self._loops.step(v, 0, start, end)
                quadratic = step.quadratic and tuple(map(thin, step.quadratic))
                self._steps[key] = thin(step.gain), quadratic
        return self._steps[key]


def may_be_closed(tangent: _Pair) -> bool:
    """Whether C of a tangent S / C may be 0 or negative, as at a fold that is closed or beyond."""
    return tangent[0].coefficients[0].sign() <= 0


def length(sheet: PanelSheet, v: int, u: int) -> Interval:
    """The distance between two vertices."""
    d = sheet.vector(v, u)
    return thin(dot(d, d)).root()


def _letters(sheet: PanelSheet, given: Any) -> dict[Edge, str]:
    """Read the letter of every fold."""
    right = isinstance(given, str) and len(given) == len(sheet.folds) and set(given) <= set("MVF")
    require(right, "the assignment does not have a letter M, V or F for each fold")
    return dict(zip(sheet.folds, given, strict=True))


def _edges(value: Any) -> list[Edge]:
    edges = []
    for edge in items(value, "drivers"):
        i, j = (natural(v, "a vertex") for v in items(edge, "an edge", 2))
        edges.append((i, j))
    return edges


def _number(tower: Tower, value: Any) -> Number:
    return Number(tower, tuple(parse_rational(c) for c in items(value, "a number", tower.size)))
