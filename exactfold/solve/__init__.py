"""Finds candidates numerically or exactly, and proves that they are roots."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
