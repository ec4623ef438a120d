"""Every export is read back by an independent parser and compared exactly."""

import re
import shutil
import subprocess
from collections import Counter
from fractions import Fraction

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.errors import UsageError
from exactfold.interop.export import (
    chart_names,
    to_homotopy_continuation,
    to_macaulay2,
    to_msolve,
    to_singular,
    to_sympy,
)
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.msolve import find_msolve

PATTERN = CreasePattern(
    [(0, 0), (1, 0), (1, 1), (0, 1), ("1/3", "1/4"), ("3/4", "1/3"), ("1/2", "3/4")],
    [(4, 5, 6), (0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (3, 4, 6), (3, 0, 4)],
)
integers = st.integers(-(10**30), 10**30) | st.integers(-2, 2)


@st.composite
def systems(draw, size=2):
    matrices = []
    for _ in range(size):
        rows = [[0] * (size + 1) for _ in range(size + 1)]
        for i in range(size + 1):
            for j in range(i + 1):
                rows[i][j] = rows[j][i] = draw(integers)
        matrices.append(tuple(map(tuple, rows)))
    return QuadraticSystem(tuple(matrices))


def parse(text, names):
    """{exponents: coefficient} of "-3*x^2+x*y-5", by splitting at signs; nothing is shared
    with the writer."""
    total = Counter()
    for sign, body in re.findall(r"([+-]?)([^+-]+)", re.sub(r'\s|big|"', "", text)):
        exponents, coefficient = [0] * len(names), -1 if sign == "-" else 1
        for factor in body.split("*"):
            base, _, power = factor.partition("^")
            if base in names:
                exponents[names.index(base)] += int(power or 1)
            else:
                assert not power
                coefficient *= int(base)
        total[tuple(exponents)] += coefficient
    return {e: c for e, c in total.items() if c}


def expected(system):
    """The polynomials by evaluation: coefficients from values at a few points."""
    result = []
    n = system.size
    for p in range(n):

        def at(*places, p=p):
            x = [Fraction(places.count(k)) for k in range(n)]
            return system.values_at(x)[p]

        terms = {}
        constant = at()
        for i in range(n):
            unit = tuple(int(k == i) for k in range(n))
            plus, twice = at(i), at(i, i)
            square = (twice - 2 * plus + constant) / 2
            terms[tuple(2 * a for a in unit)] = square
            terms[unit] = plus - constant - square
            for j in range(i):
                mixed = tuple(int(k in (i, j)) for k in range(n))
                terms[mixed] = at(i, j) - at(i) - at(j) + constant
        terms[(0,) * n] = constant
        result.append({e: c for e, c in terms.items() if c})
    return result


def split_msolve(text):
    head, characteristic, rest = text.split("\n", 2)
    assert characteristic == "0"
    return head.split(","), rest.rstrip("\n").split(",\n")


def split_macaulay2(text):
    match = re.fullmatch(
        r"R = QQ\[(.*), MonomialOrder => GRevLex\];\nI = ideal\(\n(.*)\n\);\n", text, re.S
    )
    return match[1].split(","), match[2].split(",\n")


def split_singular(text):
    match = re.fullmatch(r"ring R = 0, \((.*)\), dp;\nideal I =\n(.*);\n", text, re.S)
    return match[1].split(","), match[2].split(",\n")


def split_julia(text):
    match = re.fullmatch(
        r"using HomotopyContinuation\n@var (.*)\nF = System\(\[\n(.*)\n\], "
        r"variables = \[(.*)\]\)\n",
        text,
        re.S,
    )
    assert match[1].split() == match[3].split(", ")
    return match[1].split(), match[2].split(",\n")


FORMATS = [
    (to_msolve, split_msolve),
    (to_macaulay2, split_macaulay2),
    (to_singular, split_singular),
    (to_homotopy_continuation, split_julia),
]


@pytest.mark.parametrize(("write", "split"), FORMATS)
@settings(max_examples=40)
@given(system=systems())
def test_read_back(write, split, system):
    names, polynomials = split(write(system))
    assert names == ["x0", "x1"]
    assert [parse(text, names) for text in polynomials] == expected(system)
    assert not any(text.strip().startswith("+") for text in polynomials)


@settings(max_examples=40)
@given(systems())
def test_sympy_read_back(system):
    expressions, symbols = to_sympy(system)
    assert [str(s) for s in symbols] == ["x0", "x1"]
    found = []
    for expression in expressions:
        terms = sympy.Poly(expression, *symbols).terms()
        found.append({e: int(c) for e, c in terms if c})
    assert found == expected(system)


@pytest.mark.parametrize(("write", "split"), FORMATS)
def test_chart_read_back(write, split):
    chart = BranchSystem(PATTERN).chart
    names, polynomials = split(write(chart.system, chart_names(chart)))
    assert names == ["h4", "h5", "h6"]
    assert [parse(text, names) for text in polynomials] == expected(chart.system)


@pytest.mark.parametrize(("write", "split"), FORMATS)
def test_branch_system_read_back(write, split):
    system = BranchSystem(PATTERN)
    names, polynomials = split(write(system))
    assert names == [f"h{v}" for v in system.variables]
    heights = {v: Fraction(3 * v + 1, v + 2) for v in system.variables}
    for text, form in zip(polynomials, system.quadrics.values(), strict=True):
        terms = parse(text, names)
        assert all(sum(e) == 2 for e in terms)
        for scale in (1, 2, 5):
            moved = {v: h + scale * (v % 3) for v, h in heights.items()}
            value = Fraction(0)
            for exponents, coefficient in terms.items():
                product = Fraction(coefficient)
                for name, power in zip(names, exponents, strict=True):
                    product *= moved[int(name[1:])] ** power
                value += product
            ratio = value / form(moved)
            assert ratio > 0
            assert ratio.denominator == 1


def test_julia_integers_are_arbitrary_precision():
    huge = 10**40 + 1
    text = to_homotopy_continuation(QuadraticSystem((((huge, 0), (0, -1)),)))
    assert f'big"{huge}"*x0^2' in text
    assert not re.search(r'(?<![\w"^])\d', text.split("[", 1)[1].replace('big"', '"'))


def test_integers_beyond_the_text_limit():
    huge = 10**5000 + 7
    text = to_msolve(QuadraticSystem((((huge, 0), (0, 0)),)))
    assert "1" + "0" * 4999 + "7*x0^2" in text


def test_zero_polynomial():
    zero = QuadraticSystem((((0, 0), (0, 0)),))
    assert to_msolve(zero).split("\n")[2] == "0"
    assert to_sympy(zero)[0] == [0]
    assert 'big"0"' in to_homotopy_continuation(zero)


@pytest.mark.parametrize("names", [["a"], ["a", "a"], ["a", "b", "c"]])
def test_wrong_names_error(names):
    system = QuadraticSystem((((0,) * 3,) * 3,) * 2)
    with pytest.raises(UsageError, match="2 different names"):
        to_msolve(system, names)


@pytest.mark.parametrize("name", ["2x", "a_b", "a b", "", "h'"])
def test_unusable_name_error(name):
    with pytest.raises(UsageError, match="letters and digits"):
        to_singular(QuadraticSystem((((1, 0), (0, 1)),)), [name])


def run(program, *arguments, script=None):
    if shutil.which(program) is None:
        pytest.skip(f"{program} is not installed")
    done = subprocess.run(
        [program, *arguments],
        input=script,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return done.stdout


def test_singular_finds_every_solution():
    chart = BranchSystem(PATTERN).chart
    script = to_singular(chart.system, chart_names(chart)) + "ideal G = std(I);\nvdim(G);\nquit;\n"
    assert run("Singular", "-q", script=script).split() == ["8"]


def test_macaulay2_finds_every_solution(tmp_path):
    chart = BranchSystem(PATTERN).chart
    file = tmp_path / "system.m2"
    file.write_text(to_macaulay2(chart.system, chart_names(chart)) + "print(degree I, dim I)\n")
    assert run("M2", "--script", str(file)).split("\n")[0] == "(8, 0)"


def test_msolve_finds_every_solution(tmp_path):
    chart = BranchSystem(PATTERN).chart
    file, output = tmp_path / "system.ms", tmp_path / "solutions"
    file.write_text(to_msolve(chart.system, chart_names(chart)))
    run(find_msolve() or "msolve", "-f", str(file), "-o", str(output), "-t", "1")
    boxes = re.findall(r"\[[^\[\]]*/[^\[\]]*\]", output.read_text())
    assert len(boxes) == 8 * chart.system.size
