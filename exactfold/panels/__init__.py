"""Motions of sheets of rigid panels: which exist to second order, and which truly fold."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
