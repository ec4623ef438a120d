"""Numbers and linear algebra over Q."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
