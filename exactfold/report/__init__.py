"""What people read: answers in plain words and tables, with rich."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
