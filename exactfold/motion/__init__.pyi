from exactfold.motion.angles import fold_angles_of as fold_angles_of
from exactfold.motion.framework import Framework as Framework
from exactfold.motion.start import Start as Start
