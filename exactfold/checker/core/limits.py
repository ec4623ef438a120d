"""What one file may ask for, in one table: readers of drawings, patterns and certificates use it.

A limit bounds memory and time. Each leaves room for far larger work than exactfold was seen to do.
"""

from __future__ import annotations

# --- any file ------------------------------------------------------------------------------------
MOST_BYTES = 1 << 30  # of a drawing, a pattern, or a certificate that is one JSON object
MOST_NUMBER = 1 << 16  # digits of a number, before and after the stroke of a fraction each
MOST_EXPONENT = 20_000  # of a decimal number
MOST_ROOTS = 6  # square roots that the coordinates of a sheet are made of

# --- coordinates ---------------------------------------------------------------------------------
MOST_COORDINATE = 10_000  # digits of the numerator or of the denominator
LONG_COORDINATE = 100  # digits beyond which a coordinate counts as long
MOST_PRODUCTS = 10**8  # numerator times denominator, in digits, of all long coordinates
MOST_COMMON = 1 << 35  # coordinates times squares of their 64-bit words over one denominator
LARGEST, SMALLEST = 50, 50  # powers of ten: a drawing is from 1e-50 to 1e50 large

# --- drawings ------------------------------------------------------------------------------------
MOST_LINES = 500_000  # of a drawing
MOST_CROSSINGS = 100_000  # of lines of a drawing
MOST_PAIRS = 2 * 10**9  # of lines above one another, compared by arrays of floats
MOST_NEAR = 5 * 10**7  # pairs of points nearer than what may be merged
MOST_COMPARED = 10**9  # pairs of edges above one another, compared one by one
MOST_FRAMES = 1000  # of a FOLD file that are looked at for a flat one
MOST_INHERITED = 100  # frames that one frame inherits from
MOST_DEPTH = 200  # elements of an SVG file inside each other, with those that `use` brings in
MOST_USED = 100_000  # elements that `use` repeats
MOST_TEXT = 4000  # characters of an attribute or of a style, and of the transforms of an element
MOST_TRANSFORMS = 2 * 10**7  # characters of the transforms of all elements

# --- sheets of certificates ----------------------------------------------------------------------
MOST_ABOVE = 1 << 27  # pairs of edges above one another, whose boxes are compared
MOST_MEETINGS = 1 << 20  # pairs of edges whose boxes meet, compared exactly

# --- listings and proofs of one branch -----------------------------------------------------------
MOST_BITS = 1 << 14  # of a box in a listing, and digits of its numbers

# --- compact certificates ------------------------------------------------------------------------
MOST_UNITS = 52  # bits of the boxes in a compact block, and the largest radius byte
MOST_WIDTH = 8  # bytes of a centre
MOST_BLOCK = 1 << 16  # roots in a block
MOST_UNKNOWNS = 40
MOST_LINE = 1 << 25  # bytes of a line
MOST_DIGITS = 4000  # of an exact root in a block, and its bits
MOST_ENTRIES = 1 << 20  # roots that are listed one by one

# --- motions -------------------------------------------------------------------------------------
MOST_TUBES = 1 << 12  # of a motion
MOST_WORK = 1 << 34  # of a motion: products of numbers of 256 bits, nearly; under an hour
MOTION_BITS = 1 << 11  # of a motion
MOST_TESTS = 1 << 23  # of contacts of a motion: of two faces, or to place a vertex; under an hour
NODE_WORK = 16  # tubes that a node is counted for

# --- letters and pieces --------------------------------------------------------------------------
MOST_OPEN = 1 << 12  # words that the open letters of one assignment may still become
ASSIGNED_VERTICES = 8  # that can pop, of a sheet whose assignments are listed
PIECE_VERTICES = 16  # that can pop, of a sheet whose pieces are counted
PIECE_UNKNOWNS = 9  # of solutions with flat vertices
MOST_MONOMIALS = 500  # of a system that has no zero

# --- panels --------------------------------------------------------------------------------------
MOST_SETS = 1 << 20  # steps to the components
CONE_FORMS = 16  # of the vertices of one space
MOST_CONDITIONS = 1 << 11  # of a motion with given letters
MOST_SHIFT = 1 << 10  # bits by which its numbers are moved
MOST_BENT = 6  # transmissions that are not linear, round one loop
MODE_STEPS = 1 << 20  # of one search for supports
MODE_ROWS = 1 << 16  # of one table
MODE_ROOTS = 7  # adjoined at once to prove that a number is 0
SPACE_ROOTS = 8  # adjoined to have the numbers of two spaces in one field
SPACE_STEPS = 1 << 22  # products of densities in one search
SPACE_LEAVES = 1 << 12  # spaces of motions of one part
MOST_LISTED = 1 << 12  # modes of one support that are looked at one by one
MOST_SUPPORTS = 1 << 15  # of a sheet
