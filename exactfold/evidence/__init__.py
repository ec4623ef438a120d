"""Evidence, written and read back: listings, streamed files, single branches."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
