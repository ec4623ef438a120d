"""The same problem in the languages of other programs."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
