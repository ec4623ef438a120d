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
MOST_COMMON = (
    1 << 35
)  # coordinates times the square of the 64-bit words of each, on one denominator
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
