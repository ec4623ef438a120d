"""`exactfold serve`: the page of the viewer with the engine behind it, on this machine only."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
