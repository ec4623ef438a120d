from exactfold.panels.decomposition import decompose as decompose
from exactfold.panels.elementary import Support as Support
from exactfold.panels.extension import Extension as Extension
from exactfold.panels.result import Decomposition as Decomposition
from exactfold.panels.result import Mode as Mode
from exactfold.panels.subspaces import Leaf as Leaf
