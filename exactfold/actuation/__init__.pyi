from exactfold.actuation.directions import Directions as Directions
from exactfold.actuation.drive import MOST_FOLDABLE as MOST_FOLDABLE
from exactfold.actuation.drive import actuate as actuate
from exactfold.actuation.every import actuate_all as actuate_all
from exactfold.actuation.orthogonal import OrthogonalTorques as OrthogonalTorques
from exactfold.actuation.result import Actuation as Actuation
from exactfold.actuation.result import Ranked as Ranked
