"""From a wish to a way to fold: the letters asked for, and torques that drive one branch."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
