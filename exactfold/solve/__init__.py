"""Candidates for the branches, in floating point; nothing here is proved."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
