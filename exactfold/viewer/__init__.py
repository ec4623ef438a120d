"""The viewer: one HTML file with the pattern, its ways to fold, and the sheet in motion."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
