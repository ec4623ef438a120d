"""From candidates to proofs: numerical solvers, exact engines, and certifiers."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
