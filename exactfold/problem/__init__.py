"""The exact equations of a sheet, with its gauge written down."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
