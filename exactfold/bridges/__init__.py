"""The same problem in the languages of other programs."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
