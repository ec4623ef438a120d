from exactfold.panels.decomposition import decompose as decompose
from exactfold.panels.modes.elementary import Support as Support
from exactfold.panels.modes.extension import Extension as Extension
from exactfold.panels.result import Decomposition as Decomposition
from exactfold.panels.result import Mode as Mode
from exactfold.panels.spaces.subspaces import Leaf as Leaf
