"""Which motion of a sheet of panels a certificate is about, and its fold angles.

At each vertex whose folds are active the file gives their densities, angle / length at first order.
With tau = tan(angle / 2) / length a vertex closes iff the vector part of the product of the
quaternions 1 + tau_j d_j is 0. Modes in which it is 0 for tau = T w, for all T, fold so until all
their folds are closed. Modes of vertices with at most four active folds, whose transmissions close
all loops, fold until the first fold is closed (docs/panel_motion.md, 1 and 2).
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
    """Folds that move together: those at the vertices `near`, or one from boundary to boundary.

    `linear`: whether all vertices close for all T. `way`: vertices with a fold known by then.
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
        """All of its folds."""
        return {self.driver} | {pair(v, u) for v, around in self.near.items() for u in around}


class DrivenModes:
    """The modes that fold, verified; all their fold angles follow from those of the drivers."""

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
        """All folds that fold."""
        return {fold for mode in self.modes for fold in mode.folds}

    # --- what is verified ------------------------------------------------------------------------

    def _lines(self, near: Near, given: Any) -> dict[int, Line]:
        found: dict[int, Line] = {}
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
            require(len(turns) == 1 and 0 not in turns, f"the letters at {v} are others")
            found[v] = Line(densities, radicand)
        return found

    def _driven(self, near: Near, active: list[Edge], drivers: list[Edge]) -> list[Mode]:
        """The modes, each with its one driver, all of them verified."""
        found, left = [], set(active)
        for driver in drivers:
            require(driver in left, f"{driver} drives nothing, or what another fold drives")
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
            found.append(mode)
        require(not left, f"nothing drives {sorted(left)[:1]}")
        return found

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
        """Whether a vertex closes with tau = T w for all T."""
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
        """Refuse a vertex unless the transmissions of its densities are known."""
        near, densities = self._modes.near[v], self._modes.lines[v][0].densities
        if len(near) == 2 and self._closes(v):
            return
        require(len(near) == 4, f"the vertex {v} does not close, and has not four active folds")
        # That all sectors are less than pi follows: else the form is definite (docs/panels.md, 1).
        d = [self.sheet.vector(v, u) for u in near]
        w = [densities[u] for u in near]
        zero = w[0].tower.number(0)
        sums = [sum((a * b[k] for a, b in zip(w, d, strict=True)), zero) for k in (0, 1)]
        sums.append(
            sum((w[k] * w[j] * cross(d[k], d[j]) for j in range(4) for k in range(j)), zero)
        )
        require(not any(s.sign() for s in sums), f"the vertex {v} does not move so")

    # --- fold angles -----------------------------------------------------------------------------

    def tangents(self, driven: Callable[[Edge], _Pair]) -> dict[Edge, _Pair]:
        """For each active fold (C, S) with S / C = tan(angle / 2), from those of the drivers.

        Raises `ZeroDivisionError` where that is not certain: in modes that are not linear, where a
        fold may be closed.
        """
        found: dict[Edge, _Pair] = {}
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
                found[fold] = below, above.times(self._lengths[fold])
        return found

    def _passed(self, mode: Mode, known: _Pair, v: int, start: int, end: int) -> _Pair:
        """The pair of one fold at a vertex from that of another.

        With tau = N / C the other has the quotient N u / C, where (p + q tau^2) u^2 + b u + a = 0.
        So u = C z with A z^2 + b C z + a = 0, A = p C^2 + q N^2, and the quotient is N z.
        """
        c, n = known
        gain, quadratic = self._step(mode, v, start, end)
        if quadratic is None:
            return c, n.times(gain)
        p, q, b = quadratic
        # Of the two roots that which is the gain where the fold is flat.
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
        """The gain from one fold at a vertex to another, and (p, q, b) if it is not linear."""
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
    """Whether C of a tangent S / C may be 0 or negative, as it is from where the fold is closed."""
    return tangent[0].coefficients[0].sign() <= 0


def length(sheet: PanelSheet, v: int, u: int) -> Interval:
    """The distance of two vertices."""
    d = sheet.vector(v, u)
    return thin(dot(d, d)).root()


def _letters(sheet: PanelSheet, given: Any) -> dict[Edge, str]:
    """The letter of every fold."""
    right = isinstance(given, str) and len(given) == len(sheet.folds) and set(given) <= set("MVF")
    require(right, "the assignment has not a letter M, V or F for each fold")
    return dict(zip(sheet.folds, given, strict=True))


def _edges(value: Any) -> list[Edge]:
    found = []
    for edge in items(value, "drivers"):
        i, j = (natural(v, "a vertex") for v in items(edge, "an edge", 2))
        found.append((i, j))
    return found


def _number(tower: Tower, value: Any) -> Number:
    return Number(tower, tuple(parse_rational(c) for c in items(value, "a number", tower.size)))
