"""Crease patterns: the validated type, where patterns come from, and their files."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
