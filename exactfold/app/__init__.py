"""The parts that people use: the command line, answers in words, pictures, and the viewer."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
