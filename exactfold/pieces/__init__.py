"""The pieces of the solutions of a convex sheet with any border, and where they are joined."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
