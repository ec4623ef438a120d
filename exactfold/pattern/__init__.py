"""Crease patterns: the validated type, the builders of patterns, and the files of patterns."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
