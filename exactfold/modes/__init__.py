"""Motions of sheets of rigid panels: which exist to second order, and which truly fold."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
