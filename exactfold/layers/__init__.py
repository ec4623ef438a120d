"""Flat-folded states: where the paper lies, which layers overlap, and in which orders."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
