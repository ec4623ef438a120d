"""Branches of triangulated sheets: counted, found one by one, listed, and certified."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
