"""Torques that drive a sheet from the flat state along one branch and not along its rivals."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
