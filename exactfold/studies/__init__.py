"""Seeded ensembles of patterns: rows, each with its recipe, and tables and pictures made of them.

A study makes a row from a seeded recipe, and tables and pictures from the rows. It is one module of
this room, whose `STUDY` is a `Study`, and one line in `registry.MODULES`. The room does the rest:
`store` keeps rows in a journal as soon as they are ready, `runner` computes them on all cores or a
cluster, and `writing` writes them as CSV and Parquet. To add a study:

1.  Write `row(recipe)`, a function of the module. It returns a flat mapping of names to numbers,
    texts, None, or lists of these. The row depends on the recipe only: not on the time, not on the
    order of a set. Its key `status` is "proved" or "undecided". A value that is not proved is None,
    not a guess.
2.  Write `tables(rows)` and `figures(rows)`. Each row comes with its recipe, in one mapping. Rows
    come in the order of the recipes, and can be read several times.
3.  Choose the recipes: `square_recipes` are random squares. Raise `version` when rows change.
"""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
