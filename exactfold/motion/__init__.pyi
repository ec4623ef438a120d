from exactfold.motion.angles import fold_angles_of as fold_angles_of
from exactfold.motion.events import Event as Event
from exactfold.motion.following import follow as follow
from exactfold.motion.framework import Framework as Framework
from exactfold.motion.motion import Motion as Motion
from exactfold.motion.start import Start as Start
from exactfold.motion.writing import write_motion as write_motion
