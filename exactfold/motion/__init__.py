"""True configurations of a sheet: every branch followed from the flat state."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
