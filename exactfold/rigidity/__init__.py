"""What statics and kinematics say of the flat sheet."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
