"""What is followed of a sheet of panels: its modes and lines, each once."""

from types import SimpleNamespace

from exactfold.exact.surds import RATIONALS
from exactfold.motion.panels import followable
from exactfold.panels.spaces.subspaces import Leaf


def test_lines_over_different_fields_are_told_apart():
    """A line in Q(sqrt 2) and others in Q(sqrt 3), one of them rational in truth."""
    two, three = (RATIONALS.adjoined(d).root for d in (2, 3))
    first, second, third = (
        Leaf({(0, 1): (1,), (1, 2): (last,)}, 1, ()) for last in (two, three, two * 0 + 1)
    )
    again = Leaf({(0, 1): (1,), (1, 2): (three * 0 + 1,)}, 1, ())
    part = SimpleNamespace(spaces=(first, second, third, again), found=())
    assert [*map(id, followable._lines(part))] == [*map(id, (first, second, third))]
