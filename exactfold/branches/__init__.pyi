from exactfold.branches.angles import FoldAngles as FoldAngles
from exactfold.branches.angles import fold_angles as fold_angles
from exactfold.branches.branch import Branch as Branch
from exactfold.branches.export import BranchExport as BranchExport
from exactfold.branches.export import export_branch as export_branch
from exactfold.branches.export import exported as exported
from exactfold.branches.result import BranchCount as BranchCount
from exactfold.branches.result import Lettered as Lettered
