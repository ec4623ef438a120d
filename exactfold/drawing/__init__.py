"""Drawings of crease patterns as people have them: formats, repair, exact coordinates."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
