"""Types of the values in the JSON that commands print.

A whole document has a `TypedDict` as its type, in the module of the function that makes the
document. `exactfold.schema` makes the schemas from these types.
"""

from __future__ import annotations

from typing import Annotated, Any, TypeAlias, TypeVar

T = TypeVar("T")


class Keywords:
    """Keywords of JSON Schema for what a Python type cannot say; they stand in `Annotated`."""

    def __init__(self, **keywords: object) -> None:
        self.keywords = keywords


Rational: TypeAlias = Annotated[str, Keywords(pattern="^-?[0-9]+(/[1-9][0-9]*)?$")]
"""An exact number, as in "-2/3"."""
NotNegativeRational: TypeAlias = Annotated[str, Keywords(pattern="^[0-9]+(/[1-9][0-9]*)?$")]
Natural: TypeAlias = Annotated[int, Keywords(minimum=0)]
Positive: TypeAlias = Annotated[int, Keywords(minimum=1)]
NotNegative: TypeAlias = Annotated[float, Keywords(minimum=0)]
Degrees: TypeAlias = Annotated[float, Keywords(minimum=-180, maximum=180)]

Pair: TypeAlias = Annotated[list[T], Keywords(minItems=2, maxItems=2)]
"""Two values; if they are bounds, the lower one comes first."""
Several: TypeAlias = Annotated[list[T], Keywords(minItems=1)]
Empty: TypeAlias = Annotated[list[Any], Keywords(maxItems=0)]

VertexText: TypeAlias = Annotated[str, Keywords(pattern="^[0-9]+$")]
"""The number of a vertex, as a key."""
FoldText: TypeAlias = Annotated[str, Keywords(pattern="^[0-9]+-[0-9]+$")]
"""A fold, as "i-j" with the vertices at its ends."""
Fold: TypeAlias = Pair[Natural]
Face: TypeAlias = Annotated[list[Natural], Keywords(minItems=3)]
Triangle: TypeAlias = Annotated[list[Natural], Keywords(minItems=3, maxItems=3)]

Sign: TypeAlias = Annotated[int, Keywords(enum=[-1, 0, 1])]
Side: TypeAlias = Annotated[int, Keywords(enum=[-1, 1])]
SignsText: TypeAlias = Annotated[str, Keywords(pattern="^[-+0]*$")]
"""Signs of vertices, as in "+-0"."""
Letter: TypeAlias = Annotated[str, Keywords(enum=["M", "V", "F", "U"])]
"""Mountain, valley or flat; U is a letter that is undecided or free."""
VertexSigns: TypeAlias = dict[VertexText, Sign]
Assignment: TypeAlias = dict[FoldText, Letter]

VerdictText: TypeAlias = Annotated[str, Keywords(enum=["proved", "refuted", "undecided"])]
ProvedOrNot: TypeAlias = Annotated[str, Keywords(enum=["proved", "undecided"])]
Digest: TypeAlias = Annotated[str, Keywords(pattern="^[0-9a-f]{64}$")]
FieldName: TypeAlias = Annotated[str, Keywords(pattern="^Q")]
"""The field of the coordinates, as in "Q(sqrt 2)"."""
