"""Hypothesis strategies for patterns and the symmetries of the plane that keep Q^2."""

from fractions import Fraction

from hypothesis import settings
from hypothesis import strategies as st

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.delaunay_sheets import delaunay

quick = settings(max_examples=40, deadline=None)

PYTHAGOREAN = [(1, 0, 1), (0, 1, 1), (3, 4, 5), (5, -12, 13), (-8, 15, 17)]


def collinear(points):
    (ax, ay), (bx, by) = points[:2]
    return all((bx - ax) * (y - ay) == (by - ay) * (x - ax) for x, y in points[2:])


@st.composite
def point_sets(draw, most=12, width=6):
    """Distinct small grid points that span the plane, with many cocircular and collinear ones."""
    coordinates = st.integers(0, width)
    points = st.lists(
        st.tuples(coordinates, coordinates), min_size=3, max_size=most, unique=True
    ).filter(lambda points: not collinear(points))
    return draw(points)


def patterns(most=12):
    return point_sets(most).map(delaunay)


class Similarity:
    """x -> scale * R x + shift with a rational rotation R, reflected if `mirror`."""

    def __init__(self, triple, scale, shift, mirror):
        a, b, c = triple
        self.cosine, self.sine = Fraction(a, c), Fraction(b, c)
        self.scale, self.shift, self.mirror = scale, shift, mirror

    def __call__(self, point):
        x, y = Fraction(point[0]), Fraction(point[1])
        if self.mirror:
            y = -y
        u, v = self.cosine * x - self.sine * y, self.sine * x + self.cosine * y
        return self.scale * u + self.shift[0], self.scale * v + self.shift[1]

    def __repr__(self):
        return f"Similarity({self.cosine}, {self.sine}, {self.scale}, {self.shift}, {self.mirror})"


similarities = st.builds(
    Similarity,
    st.sampled_from(PYTHAGOREAN),
    st.sampled_from([Fraction(1), Fraction(2, 7), Fraction(1000), Fraction(1, 10**6)]),
    st.tuples(st.fractions(-3, 3, max_denominator=9), st.fractions(-3, 3, max_denominator=9)),
    st.booleans(),
)


def transformed(pattern, similarity):
    return CreasePattern([similarity(p) for p in pattern.vertices], pattern.triangles)


def relabelled(pattern, order):
    """Vertex `order[k]` of `pattern` becomes vertex k."""
    place = {v: k for k, v in enumerate(order)}
    vertices = [pattern.vertices[v] for v in order]
    return CreasePattern(vertices, [[place[v] for v in t] for t in pattern.triangles])


def same_up_to_labels(first, second):
    def faces(pattern):
        return {frozenset(pattern.vertices[v] for v in t) for t in pattern.triangles}

    return faces(first) == faces(second)
