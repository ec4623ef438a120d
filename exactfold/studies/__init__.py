"""Seeded ensembles of patterns: rows, each with its recipe, and tables and pictures made of them.

A study is a function from a seeded recipe to a row, and from rows to tables and pictures: one
module of this room, whose `STUDY` is a `Study`, and one line in `registry.MODULES`. The rest is
done here: rows are kept in a journal as they are ready (`store`), computed by all cores or a
cluster (`runner`), written as CSV and Parquet (`writing`). To add one:

1.  Write `row(recipe)`, a function of the module. It returns a flat mapping of names to numbers,
    texts, None, or lists of these, which depends on the recipe only: no time, no order of a set.
    The key `status` is "proved" or "undecided"; what is not proved is None and not a guess.
2.  Write `tables(rows)` and `figures(rows)`. A row is given to them with its recipe, as one
    mapping; rows come in the order of the recipes, and can be gone through again.
3.  Choose the recipes: `square_recipes` are random squares. Raise `version` when rows change.
"""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
