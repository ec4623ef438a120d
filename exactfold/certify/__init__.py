"""From candidates to proofs."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
