"""Answers in plain words and tables, printed with rich."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
