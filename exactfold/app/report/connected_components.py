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


def graphs(connected_components: ConnectedComponents) -> str:
    """The graphs and their connected components, in one sentence.

    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.branches import find_connected_components
    >>> graphs(find_connected_components(single_vertex(6)))
    'for all boundary heights there is exactly one shape for each of 2 choices of the vertices
    that pop up; these 2 graphs of dimension 3 form 2 connected components'
    """
    number = _power(len(connected_components.vertices))
    one = len(connected_components.vertices) == 0
    choices = "1 choice" if one else f"{number} choices"
    kinds = "this graph" if one else f"these {number} graphs"
    return (
        f"for all boundary heights there is exactly one shape for each of {choices} of the "
        f"vertices that pop up; {kinds} of dimension {connected_components.dimension} "
        f"{'forms' if one else 'form'} "
        f"{_range(connected_components.low, connected_components.high)}"
    )


def piece_notes(result: BranchCount) -> list[str]:
    """What is known of joints, of true motions, and of irreducible families."""
    connected_components = result.connected_components
    if connected_components is None:
        return []
    notes = [_numbered(connected_components)]
    if connected_components.chord is not None:
        i, j = connected_components.chord
        notes.append(f"the fold {i}-{j} from boundary to boundary joins all graphs")
    if connected_components.joints and len(connected_components.vertices) > MOST:
        notes.append(_many_joints(connected_components))
    elif connected_components.joints:
        shown = ", ".join(joint.sign_text for joint in connected_components.joints[:_SHOWN])
        more = len(connected_components.joints) - _SHOWN
        order = ", ".join(map(str, connected_components.vertices[:_SHOWN]))
        rest = f" and {more} more (--json)" if more > 0 else ""
        dots = ", ..." if len(connected_components.vertices) > _SHOWN else ""
        notes.append(
            "graphs meet at solutions on which some stars are flat; these have the following signs "
            f"of the vertices {order}{dots}, 0 where flat, or the opposite signs: {shown}{rest}"
        )
    if connected_components.never_flat:
        names = ", ".join(map(str, list(connected_components.never_flat)[:_SHOWN]))
        names += ", ..." if len(connected_components.never_flat) > _SHOWN else ""
        which = counted(len(connected_components.never_flat), "vertex")
        are = agreeing(len(connected_components.never_flat), "is")
        notes.append(f"{which} {are} never flat when the sheet starts to fold: {names}")
    true = _range(connected_components.low, connected_components.true_high)
    notes.append(f"the true motions near the flat state form as many graphs, with {true}")
    families = result.families
    if families is not None and families.status is PROVED and families.second_order is not None:
        kinds = ", ".join(f"{n} of dimension {d}" for d, n in families.second_order.items())
        notes.append(f"irreducible components: {kinds}")
    if result.warning is not None:
        notes.append(f"warning: {result.warning}")
    return notes


def _numbered(connected_components: ConnectedComponents) -> str:
    """How the graphs are numbered: by the signs of the vertices, the first of them up."""
    vertices = connected_components.vertices
    if not vertices:
        return "way 1 is this graph: one family over all boundary heights"
    number, rest = _power(len(vertices) - 1), len(vertices) - 1
    if not rest:
        return f"the graphs are mirror images: one family, way 1, with vertex {vertices[0]} up"
    order = ""
    if len(vertices) <= _SHOWN:
        names = ", ".join(map(str, vertices))
        order = f"; the vertices {names} are {'+' * len(vertices)}, {'+' * rest}-, and so on"
    return (
        f"each graph has another as its mirror image: so they are {number} families, ways 1 to "
        f"{number}, each over all boundary heights, with vertex {vertices[0]} up{order}"
    )


def _many_joints(connected_components: ConnectedComponents) -> str:
    """How many joints there are on a large sheet, and how many stars are flat there."""
    number, stars = len(connected_components.joints), len(connected_components.vertices)
    flat = sorted(
        sum(not sign for sign in joint.signs.values()) for joint in connected_components.joints
    )
    some = f"{flat[0]}" if flat[0] == flat[-1] else f"{flat[0]} to {flat[-1]}"
    return (
        f"graphs meet at {counted(number, 'solution')} on which {some} of the {stars} stars are "
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
