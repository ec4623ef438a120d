from exactfold.modes.decomposition import Decomposition as Decomposition
from exactfold.modes.decomposition import Mode as Mode
from exactfold.modes.decomposition import decompose as decompose
from exactfold.modes.elementary import Support as Support
from exactfold.modes.extension import Extension as Extension
from exactfold.modes.subspaces import Leaf as Leaf
