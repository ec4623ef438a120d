"""Which branches have given mountains and valleys, and why the others have not."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
