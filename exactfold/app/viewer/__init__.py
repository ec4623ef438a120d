"""The viewer: one HTML file with the pattern, its ways to fold, and the sheet in motion."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
