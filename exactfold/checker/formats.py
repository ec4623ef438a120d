"""Formats, versions and limits of certificates: writers take them from here."""

from __future__ import annotations

LISTING, LISTING_VERSION = "exactfold certificate", 2
"""All branches of a sheet in one JSON object (docs/certificate.md)."""

COMPACT, COMPACT_VERSION = "exactfold compact certificate", 1
"""One root for each sign vector, line by line (docs/compact-certificate.md)."""

BRANCH, BRANCH_VERSION = "exactfold branch", 1
"""One branch with given vertex signs (docs/branch.md)."""

CURVED_VERSION = 2
"""The same with angle deficits: one shape of a sheet that is not flat by itself."""

LETTERS, LETTERS_VERSION = "exactfold letters", 1
"""All halves of branches with given mountains and valleys (docs/assignment.md)."""

ASSIGNMENTS, ASSIGNMENTS_VERSION = "exactfold assignments", 1
"""All mountain-valley assignments of a sheet with five corners (docs/circles.md)."""

PANEL_LETTERS, PANEL_LETTERS_VERSION = "exactfold letters on panels", 1
"""Whether rigid panels start to fold with given mountains and valleys (docs/assignment.md)."""

PIECES, PIECES_VERSION = "exactfold pieces", 1
"""Into how many pieces the solutions fall with more than four corners (docs/any_border.md)."""

PANELS, PANELS_VERSION = "panels", 3
"""All motions of a sheet of rigid panels: a kind of the format `LISTING` (docs/certificate.md)."""

MOTION, MOTION_VERSION = "exactfold motion", 1
"""The motion along a half-branch, as a chain of tubes (docs/motion.md)."""

PANEL_MOTION, PANEL_MOTION_VERSION = "exactfold panel motion", 1
"""A motion of rigid panels, and what touches first (docs/panel_motion.md)."""

RATED_VERSION = 2
"""The same of modes and free folds that move at rates of their own."""

LOOPS, LOOPS_VERSION = "exactfold loops", 1
"""The loops of true motions through the flat state, line by line (docs/motions.md)."""

# Bounds on the memory and the work that one file can ask for.
MOST_BITS = 1 << 14  # of a box in a listing, and digits of its numbers
MOST_UNITS = 52  # bits of the boxes in a compact block, and the largest radius byte
MOST_WIDTH = 8  # bytes of a centre
MOST_BLOCK = 1 << 16  # roots in a block
MOST_UNKNOWNS = 40
MOST_LINE = 1 << 25  # bytes of a line
MOST_TUBES = 1 << 12  # of a motion
MOST_WORK = 1 << 34  # of a motion: products of numbers of 256 bits, nearly; under an hour
MOTION_BITS = 1 << 11  # of a motion
MOST_TESTS = 1 << 23  # of contacts of a motion: of two faces, or to place a vertex; under an hour
NODE_WORK = 16  # tubes that a node is counted for
MOST_DIGITS = 4000  # of an exact root in a block, and its bits

UNPROVED = 255
"""The radius byte of a root that is given under "exact"."""

FACTS = "interior boundary folds degrees_of_freedom sha256"
COUNTS = "distinct with_multiplicity real nonreal true_branches"
