"""The commands that make pictures and pages."""

from __future__ import annotations

from typing import Any

from exactfold.app.options.pictures import DrawOptions, ViewOptions
from exactfold.app.shell.usage import taking

# Each command imports what it needs, as in `cli`.


@taking(DrawOptions)
def draw(**options: Any) -> int:
    """Draw a crease pattern, one way to fold it, or all ways, as SVG, PNG or PDF.

    Mountains are red, valleys blue and dashed; the wider a fold, the more it
    folds. Triangles point up at vertices that pop up. Without a way, the letters
    of the file are drawn. A file that is no sheet is drawn as it is.
    """
    from exactfold.app.commands.draw import Wanted

    return Wanted(**options).answer()


@taking(ViewOptions)
def view(**options: Any) -> int:
    """Show a sheet and its ways to fold in the browser: one HTML file that needs no network.

    The crease pattern stands beside the sheet in space, with a slider from flat
    to the first contact. A click on a vertex pops it through, a click on a fold
    asks for a mountain or a valley.
    """
    from exactfold.app.commands.view import Wanted

    Wanted(**options).run()
    return 0


COMMANDS = (draw, view)
"""In the order in which the help lists them."""
