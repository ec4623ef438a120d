"""The conveyor: from a problem by ends and roots to branches, block by block."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
