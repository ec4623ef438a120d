"""Crease patterns: the validated type, where patterns come from, and their files."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
