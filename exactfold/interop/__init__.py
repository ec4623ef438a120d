"""Writes sheets, equations and motions for other programs, and reads some of them back."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
