from exactfold.modes.decomposition import decompose as decompose
from exactfold.modes.elementary import Support as Support
from exactfold.modes.extension import Extension as Extension
from exactfold.modes.result import Decomposition as Decomposition
from exactfold.modes.result import Mode as Mode
from exactfold.modes.subspaces import Leaf as Leaf
