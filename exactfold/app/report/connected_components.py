"""What `exactfold count` prints of a sheet with a convex boundary and more than four corners."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from exactfold._support.plurals import agreeing, counted
from exactfold._support.verdict import PROVED
from exactfold.app.report.terminal import MOST

if TYPE_CHECKING:
    from exactfold.branches.connected_components.result import ConnectedComponents
    from exactfold.branches.values.result import BranchCount

_SHOWN: Final = 8


def families(vertices: int, dimension: int) -> str:
    """How many families there are with so many foldable vertices, mirror images together.

    >>> families(1, 3), families(5, 5)
    ('1 family of ways to fold, of dimension 3', '16 families of ways to fold, each of dimension 5')
    """
    exponent = max(vertices - 1, 0)
    many = exponent > 0
    return (
        f"{_power(exponent)} {'families' if many else 'family'} of ways to fold, "
        f"{'each ' if many else ''}of dimension {dimension}"
    )


CHOICES: Final = "one for each choice of the vertices that pop up, seen from one side"
"""What tells the families apart, if there are several foldable vertices."""


def families_answer(pieces: ConnectedComponents) -> tuple[str, str]:
    """How many families there are; and what tells them apart, and how many components they form.

    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.branches import find_connected_components
    >>> families_answer(find_connected_components(single_vertex(6)))
    ('1 family of ways to fold, of dimension 3',
     'with its mirror image it forms 2 connected components')
    """
    number = len(pieces.vertices)
    form = _range(pieces.low, pieces.high)
    if number > 1:
        what = f"{CHOICES}; with their mirror images they form {form}"
    else:
        what = f"with its mirror image it forms {form}" if number else f"it forms {form}"
    return families(number, pieces.dimension), what


def piece_notes(result: BranchCount) -> list[str]:
    """What is known of joints, of true motions, and of irreducible families."""
    connected_components = result.connected_components
    if connected_components is None:
        return []
    notes = [_numbered(connected_components)]
    if connected_components.chord is not None:
        i, j = connected_components.chord
        notes.append(f"the fold {i}-{j} from boundary to boundary joins all families")
    if connected_components.joints and len(connected_components.vertices) > MOST:
        notes.append(_many_joints(connected_components))
    elif connected_components.joints:
        shown = ", ".join(joint.sign_text for joint in connected_components.joints[:_SHOWN])
        more = len(connected_components.joints) - _SHOWN
        order = ", ".join(map(str, connected_components.vertices[:_SHOWN]))
        rest = f" and {more} more (--json)" if more > 0 else ""
        dots = ", ..." if len(connected_components.vertices) > _SHOWN else ""
        notes.append(
            "families meet at solutions on which some stars are flat; these have the following "
            f"signs of the vertices {order}{dots}, 0 where flat, or the opposite signs: "
            f"{shown}{rest}"
        )
    if connected_components.never_flat:
        names = ", ".join(map(str, list(connected_components.never_flat)[:_SHOWN]))
        names += ", ..." if len(connected_components.never_flat) > _SHOWN else ""
        which = counted(len(connected_components.never_flat), "vertex")
        are = agreeing(len(connected_components.never_flat), "is")
        notes.append(f"{which} {are} never flat when the sheet starts to fold: {names}")
    true = _range(connected_components.low, connected_components.true_high)
    notes.append(f"the true motions near the flat state form as many families, with {true}")
    families = result.families
    if families is not None and families.status is PROVED and families.second_order is not None:
        kinds = ", ".join(f"{n} of dimension {d}" for d, n in families.second_order.items())
        notes.append(f"irreducible components that the families lie in: {kinds}")
    if result.warning is not None:
        notes.append(f"warning: {result.warning}")
    return notes


def _numbered(connected_components: ConnectedComponents) -> str:
    """How the families are numbered: by the signs of the vertices, the first of them up."""
    vertices = connected_components.vertices
    each = "for all boundary heights it has exactly one shape"
    if not vertices:
        return f"way 1 is this family: {each}"
    rest = len(vertices) - 1
    if not rest:
        return f"way 1 is this family, with vertex {vertices[0]} up: {each}"
    order = ""
    if len(vertices) <= _SHOWN:
        names = ", ".join(map(str, vertices))
        signs = f"{'+' * len(vertices)}, {'+' * rest}-, ..."
        order = f"; in ways 1, 2 and so on the vertices {names} are {signs}"
    return (
        f"ways 1 to {_power(rest)} are the families, each with vertex {vertices[0]} up: for all "
        f"boundary heights each has exactly one shape{order}"
    )


def _many_joints(connected_components: ConnectedComponents) -> str:
    """How many joints there are on a large sheet, and how many stars are flat there."""
    number, stars = len(connected_components.joints), len(connected_components.vertices)
    flat = sorted(
        sum(not sign for sign in joint.signs.values()) for joint in connected_components.joints
    )
    some = f"{flat[0]}" if flat[0] == flat[-1] else f"{flat[0]} to {flat[-1]}"
    return (
        f"families meet at {counted(number, 'solution')} on which {some} of the {stars} stars are "
        "flat; --json has their signs"
    )


def _range(low: int, high: int) -> str:
    if low == high:
        return "1 connected component" if low == 1 else f"{_long(low)} connected components"
    return f"{_long(low)} to {_long(high)} connected components"


def _power(exponent: int) -> str:
    return str(1 << exponent) if exponent < 20 else f"2^{exponent}"


def _long(value: int) -> str:
    if value < 1 << 20:
        return str(value)
    if not value & (value - 1):
        return f"2^{value.bit_length() - 1}"
    return f"about 10^{len(str(value)) - 1}"
