"""True configurations of a sheet: every branch followed from the flat state."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
