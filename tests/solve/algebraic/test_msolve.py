"""msolve: its recorded output, impostors in its place, and the program itself where installed."""

import sysconfig

import pytest
from sheets import with_point

from exactfold.errors import (
    NotApplicableError,
    PackageMissingError,
    SolverError,
)
from exactfold.pattern import families
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.algebraic.msolve import (
    find_msolve,
    msolve_classes,
    parse_output,
    run_msolve,
    to_root_class,
)

# x0^2 = 2, x1^2 = 2: msolve 0.10.1 added the variable A with x0 + 2 x1 + A = 0.
SQUARES = QuadraticSystem((((1, 0, 0), (0, 0, 0), (0, 0, -2)), ((0, 0, 0), (0, 1, 0), (0, 0, -2))))
RECORDED = """[0, [0,
3,
4,
['x0', 'x1', 'A'],
[1,2,1],
[1,
[[4, [36, 0, -20, 0, 1]],
[3, [0, -40, 0, 4]],
[
[[3, [48, 0, 8, 0]],
1],
[[3, [-96, 0, 16, 0]],
1]
]]]]]:
"""
# x0^2 = x1, x1^2 = 0, the variables in another order.
FOURFOLD = "[0, [0, 2, 4, ['x1', 'x0'], [0, 1], [1, [[1, [0, 1]], [0, [1]], [[[0, [0]], 1]]]]]]:"
PARABOLA = QuadraticSystem((((2, 0, 0), (0, 0, -1), (0, -1, 0)), ((0, 0, 0), (0, 1, 0), (0, 0, 0))))

installed = pytest.mark.skipif(find_msolve() is None, reason="msolve is not installed")


def chart_system(pattern):
    return BranchSystem(pattern).chart.system


def impostor(folder, monkeypatch, script):
    """A shell script in the place of msolve; $5 and $6 are its option -o and the output file."""
    path = folder / "msolve"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    monkeypatch.setenv("PATH", str(folder), prepend=":")
    return str(path)


def says(text):
    return f"cat > \"$6\" <<'END'\n{text}\nEND"


def test_recorded_output_with_a_form_of_its_own():
    root_class = to_root_class(parse_output(RECORDED), ("x0", "x1"))
    root_class.verify(SQUARES)
    assert root_class.polynomial == (36, 0, -20, 0, 1)
    assert root_class.separating == (-1, -2)


def test_recorded_output_in_another_order_of_the_variables():
    root_class = to_root_class(parse_output(FOURFOLD), ("x0", "x1"))
    root_class.verify(PARABOLA)
    assert root_class.separating == (1, 0)


@pytest.mark.parametrize("text", ["[-1]:", "[1, 2, -1, []]:\n"])
def test_output_without_a_parametrisation(text):
    assert parse_output(text) is None


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[0",
        "Segmentation fault",
        "[0, 1]:",
        "[0, [7, 1, 2, ['x'], [1], [1, [[1, [-1, 1]], [0, [1]], []]]]]:",
        "[0, [0, 2, 2, ['x', 'y'], [0, 1], [1, [[1, [-1, 1]], [0, [1]], []]]]]:",
        RECORDED.rstrip() + " [1]",
        RECORDED.rstrip()[:-3],
    ],
)
def test_output_not_understood_error(text):
    with pytest.raises(SolverError, match="cannot be read"):
        parse_output(text)


def test_coefficients_of_any_length():
    long = "1" + 5000 * "0"
    text = f"[0, [0, 1, 1, ['x'], [1], [1, [[1, [-{long}, 1]], [0, [1]], []]]]]:"
    assert parse_output(text).polynomial == (-(10**5000), 1)


@pytest.mark.parametrize(
    ("change", "by", "message"),
    [
        ("'x1'", "'y'", "answered for the unknowns"),
        ("-40", "-41", "is not w'"),
        ("[1,2,1]", "[1,2,3]", "integral"),
    ],
)
def test_parametrisation_of_something_else_error(change, by, message):
    with pytest.raises(SolverError, match=message):
        to_root_class(parse_output(RECORDED.replace(change, by)), ("x0", "x1"))


def test_an_oracle_that_tells_the_truth(tmp_path, monkeypatch):
    binary = impostor(tmp_path, monkeypatch, says(RECORDED))
    assert find_msolve() == binary
    solution = groebner(SQUARES, engine="msolve")
    assert solution.engine == "msolve"
    assert [(c.polynomial, c.multiplicity) for c in solution.classes] == [
        ((-18, 0, 1), 1),
        ((-2, 0, 1), 1),
    ]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("48", "49"), "does not vanish on the root class"),
        (("36", "35"), "does not vanish on the root class"),
        (("[1,2,1]", "[2,1,1]"), "not the stated linear form"),
    ],
)
def test_an_oracle_that_errs_is_found_out_error(change, said, tmp_path, monkeypatch):
    impostor(tmp_path, monkeypatch, says(RECORDED.replace(*change)))
    with pytest.raises(SolverError, match=said):
        msolve_classes(SQUARES)


def test_an_oracle_that_withholds_zeros_error(tmp_path, monkeypatch):
    """Two true zeros of the four."""
    found = to_root_class(parse_output(RECORDED), ("x0", "x1")).factors()[0]
    assert found.polynomial == (-18, 0, 1)
    part = (
        "[0, [0, 3, 4, ['x0', 'x1', 'A'], [1,2,1], [1, [[2, [-18, 0, 1]], [1, [0, 2]],"
        "[[[1, [12]], 1], [[1, [12]], 1]]]]]]:"
    )
    impostor(tmp_path, monkeypatch, says(part))
    with pytest.raises(NotApplicableError, match="no others"):
        msolve_classes(SQUARES)


def test_a_multiplicity_that_ranks_do_not_give_error(tmp_path, monkeypatch):
    impostor(tmp_path, monkeypatch, says(FOURFOLD))
    with pytest.raises(NotApplicableError, match="no others"):
        msolve_classes(PARABOLA)


def test_an_oracle_that_sees_no_zeros_error(tmp_path, monkeypatch):
    impostor(tmp_path, monkeypatch, says("[-1]:"))
    with pytest.raises(SolverError, match="has exactly 2"):
        msolve_classes(SQUARES)


@pytest.mark.parametrize(
    ("script", "message"),
    [
        ("echo no memory >&2; exit 139", "exit code 139: no memory"),
        ("exit 0", "exit code 0"),
        ("while :; do :; done", "did not finish"),
    ],
)
def test_a_crash_or_a_timeout_error(script, message, tmp_path, monkeypatch):
    impostor(tmp_path, monkeypatch, script)
    with pytest.raises(SolverError, match=message):
        run_msolve("x\n0\nx^2-2\n", timeout=1.0 if "while" in script else 60.0)


def test_a_file_that_is_no_program_error(tmp_path, monkeypatch):
    path = tmp_path / "msolve"
    path.write_bytes(b"\x7fELF, but not really")
    path.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(SolverError, match="could not be started"):
        run_msolve("x\n0\nx^2-2\n")


def test_msolve_that_is_not_installed_error(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(sysconfig, "get_path", lambda scheme: str(tmp_path))
    assert find_msolve() is None
    with pytest.raises(PackageMissingError, match="pip install"):
        groebner(SQUARES, engine="msolve")


def test_msolve_from_the_wheel(tmp_path, monkeypatch):
    folder = tmp_path / "sage_wheels" / "bin"
    folder.mkdir(parents=True)
    binary = folder / "msolve"
    binary.write_text("#!/bin/sh\n")
    binary.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(sysconfig, "get_path", lambda scheme: str(tmp_path))
    assert find_msolve() == str(binary)


def test_zeros_at_infinity_error():
    parallel = (((0, 1, 0), (1, 0, 0), (0, 0, -2)), ((2, 1, 0), (1, 0, 0), (0, 0, -2)))
    with pytest.raises(NotApplicableError, match="at infinity"):
        groebner(QuadraticSystem(parallel), engine="msolve")


PATTERNS = {
    "two vertices": families.two_vertex(),
    "flat vertex": families.flat_vertex_square(),
    "hypar, straight": families.hypar(1, 0),
    "degree three": with_point(families.two_vertex(), 0, (1, 2, 3)),
    "octahedron": families.flat_octahedron_in_square(),
}


@installed
@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_agreement_with_the_embedded_engines(pattern):
    system = chart_system(pattern)
    ours, theirs = groebner(system, engine="lifting"), groebner(system, engine="msolve")
    assert theirs.factor_degrees == ours.factor_degrees
    assert theirs.dimension == ours.dimension
    bits = 40

    def boxes(solution):
        return sorted(solution.real_points(bits))

    for (box, m), (other, k) in zip(boxes(ours), boxes(theirs), strict=True):
        assert m == k
        assert all(a[0] <= b[1] and b[0] <= a[1] for a, b in zip(box, other, strict=True))
