"""What all certificates share: files, journals, and checks divided among processes."""

from exactfold._support.lazy import attached as _attached

__getattr__, __dir__ = _attached(__name__)
