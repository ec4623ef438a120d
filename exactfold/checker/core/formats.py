"""Formats and versions of certificates: writers take them from here."""

from __future__ import annotations

COMPACT, COMPACT_VERSION = "exactfold compact certificate", 1
"""All branches of a sheet: one root for each sign vector, in blocks (docs/certificate.md)."""

ROOTS_VERSION = 2
"""The same of roots that are multiple, exact, or named in another way than by their signs."""

LISTING, LISTING_VERSION = "exactfold certificate", 2
"""All branches of a sheet in one JSON object, as earlier versions wrote it."""

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

UNPROVED = 255
"""The radius byte of a root that is given under "exact"."""

FACTS = "interior boundary folds degrees_of_freedom sha256"
COUNTS = "distinct with_multiplicity real nonreal true_branches"
