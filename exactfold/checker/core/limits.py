"""How much one file may ask for: one table for the readers of drawings, patterns and certificates.

Each limit bounds memory or time, and lies far above the largest work that exactfold was seen to do.
"""

from __future__ import annotations

# --- any file ------------------------------------------------------------------------------------
MOST_BYTES = 1 << 30  # bytes of a drawing, a pattern, or a certificate that is one JSON object
MOST_NUMBER = 1 << 16  # digits of an integer, and of each of the two numbers of a fraction
MOST_EXPONENT = 20_000  # size of the exponent of a decimal number
MOST_ROOTS = 6  # square roots in the field of the coordinates of one sheet

# --- coordinates ---------------------------------------------------------------------------------
MOST_COORDINATE = 10_000  # digits of the numerator or of the denominator
LONG_COORDINATE = 100  # digits beyond which a coordinate counts as long
MOST_PRODUCTS = 10**8  # sum over all long coordinates: digits of numerator times of denominator
MOST_COMMON = 1 << 35  # number of coordinates times (64-bit words over a common denominator)^2
LARGEST, SMALLEST = 50, 50  # powers of ten: the size of a drawing is from 1e-50 to 1e50

# --- drawings ------------------------------------------------------------------------------------
MOST_LINES = 500_000  # lines of a drawing
MOST_CROSSINGS = 100_000  # crossings of the lines of a drawing
MOST_PAIRS = 2 * 10**9  # pairs of lines with overlapping x-ranges, compared by arrays of floats
MOST_NEAR = 5 * 10**7  # pairs of points so near that they may be merged
MOST_COMPARED = 10**9  # pairs of edges with overlapping x-ranges, compared one by one
MOST_FRAMES = 1000  # frames of a FOLD file that are searched for a flat one
MOST_INHERITED = 100  # frames through which one frame inherits
MOST_DEPTH = 200  # nested elements of an SVG file, counted after `use` has been expanded
MOST_MOVED = 10**6  # lattice vectors by which a corner of a periodic cell is moved
MOST_USED = 100_000  # elements that `use` repeats
MOST_SELECTORS = 1000  # selectors with several parts in the style sheets of an SVG file
MOST_TEXT = 4000  # characters of an attribute or of a style, and of the transforms of an element
MOST_TRANSFORMS = 2 * 10**7  # characters of the transforms of all elements

# --- sheets of certificates ----------------------------------------------------------------------
MOST_ABOVE = 1 << 27  # pairs of edges with overlapping x-ranges, whose boxes are compared
MOST_MEETINGS = 1 << 20  # pairs of edges whose boxes meet, compared exactly
MOST_PARTS = 360  # parts of pi in a relation of angles

# --- listings and proofs of one branch -----------------------------------------------------------
MOST_BITS = 1 << 14  # bits of a box in a listing, and digits of each of its numbers

# --- compact certificates ------------------------------------------------------------------------
MOST_UNITS = 52  # bits of the boxes in a compact block, and the largest radius byte
MOST_WIDTH = 8  # bytes of a centre
MOST_BLOCK = 1 << 16  # roots in a block
MOST_UNKNOWNS = 40  # unknowns of the branch system
MOST_LINE = 1 << 25  # bytes of a line
MOST_DIGITS = 4000  # digits of each number of an exact root in a block, and bits of this root
MOST_ENTRIES = 1 << 20  # roots that are listed one by one

# --- motions -------------------------------------------------------------------------------------
MOST_TUBES = 1 << 12  # tubes of a motion
MOST_WORK = 1 << 34  # work of a motion, in products of 256-bit numbers; under an hour
MOTION_BITS = 1 << 11  # bits of the numbers of a motion
MOST_TESTS = 1 << 23  # contact tests of a motion (of two faces, or of one vertex); under an hour
NODE_WORK = 16  # an arc through a branch point counts as much work as so many tubes

# --- letters and pieces --------------------------------------------------------------------------
MOST_OPEN = 1 << 12  # ways to complete the open letters of one assignment
MOST_ASSIGNMENTS = 1 << 18  # assignments of a part of a sheet of rigid panels
LETTER_STEPS = 1 << 20  # letters of a vertex, or forcing sets, that are tried fold by fold
ASSIGNED_VERTICES = 8  # vertices that can pop, of a sheet whose assignments are listed
PIECE_VERTICES = 16  # vertices that can pop, of a sheet whose pieces are counted
PERIODIC_VERTICES = 20  # vertices of a cell whose sign vectors are counted one by one
PIECE_UNKNOWNS = 9  # unknowns of a system for solutions with flat vertices
MOST_MONOMIALS = 500  # monomials in the proof that a system has no zero

# --- panels --------------------------------------------------------------------------------------
MOST_SETS = 1 << 20  # steps of the search for components
ISOLATED_FORMS = 12  # vertices of a part whose ways are all isolated
CONE_FORMS = 64  # vertices whose curvature forms are left on one space
MOST_CONDITIONS = 1 << 11  # closing conditions of a motion with given letters
MOST_SHIFT = 1 << 10  # bits by which the numbers of such a motion are shifted
MOST_BENT = 6  # transmissions round one loop that are not linear
MODE_STEPS = 1 << 20  # steps of one search for supports
MODE_ROWS = 1 << 16  # rows of one table of modes
MODE_ROOTS = 7  # square roots that are adjoined to prove that one number is 0
SPACE_ROOTS = 8  # square roots that are adjoined to hold the numbers of two spaces in one field
SPACE_STEPS = 1 << 25  # products of densities in one search
SPACE_LEAVES = 1 << 12  # spaces of motions of one part
MOST_LISTED = 1 << 12  # modes of one support that are checked one by one
MOST_SUPPORTS = 1 << 15  # supports of a sheet
TORQUE_WAYS = 1 << 12  # ways that torques are compared with
TORQUE_RAYS = 1 << 12  # rays in the proof that no torques have a larger margin
TREE_JOINTS = 10  # folds to other vertices at one vertex of a tree
TREE_CASES = 1 << 16  # cases of one vertex of a tree

# --- tolerance ----------------------------------------------------------------------------------
TOLERANCE_UNKNOWNS = 128  # unknowns of a zero that is followed as vertices move
TOLERANCE_WORK = 1 << 26  # zeros times the third power of their unknowns

# --- flat-folded states --------------------------------------------------------------------------
IMAGE_BITS = 1 << 15  # bits of the numbers by which panels are turned
FLAT_SIDES = 1 << 27  # points times lines of a folded sheet
FLAT_PAIRS = 1 << 22  # pairs of pieces that overlap, or of folds along each other
FLAT_TESTS = 1 << 24  # groups of panels and folds whose orders are compared one by one
FLAT_LAYERS = 4  # layers on one side of the place at which a clause is true
FLAT_STEPS = 1 << 26  # literals that are read in the proofs of one file
