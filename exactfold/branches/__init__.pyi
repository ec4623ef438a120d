from exactfold.branches.certificates.check import check_compact as check_compact
from exactfold.branches.certificates.listing import certificate as certificate
from exactfold.branches.certificates.read import read_branches as read_branches
from exactfold.branches.certificates.single import branch_certificate as branch_certificate
from exactfold.branches.connected_components.certificate import (
    components_certificate as components_certificate,
)
from exactfold.branches.connected_components.joining import (
    find_connected_components as find_connected_components,
)
from exactfold.branches.connected_components.result import (
    ConnectedComponents as ConnectedComponents,
)
from exactfold.branches.connected_components.result import Joint as Joint
from exactfold.branches.counting.batch import count_many as count_many
from exactfold.branches.counting.collect import count_branches as count_branches
from exactfold.branches.counting.find import BranchFinder as BranchFinder
from exactfold.branches.counting.find import find_branch as find_branch
from exactfold.branches.counting.find import find_branches as find_branches
from exactfold.branches.counting.find import neighbours as neighbours
from exactfold.branches.counting.motion_facts import PanelFacts as PanelFacts
from exactfold.branches.counting.motion_facts import panel_facts as panel_facts
from exactfold.branches.counting.on_dask import dask_engine as dask_engine
from exactfold.branches.counting.pools import dask_pool as dask_pool
from exactfold.branches.counting.registry import METHODS as METHODS
from exactfold.branches.counting.registry import RegisteredSolver as RegisteredSolver
from exactfold.branches.counting.registry import find_candidates as find_candidates
from exactfold.branches.counting.registry import register_solver as register_solver
from exactfold.branches.counting.registry import solvers as solvers
from exactfold.branches.counting.registry import unregister_solver as unregister_solver
from exactfold.branches.counting.shapes import ShapeCount as ShapeCount
from exactfold.branches.counting.shapes import count_shapes as count_shapes
from exactfold.branches.counting.stream import StreamedCount as StreamedCount
from exactfold.branches.counting.stream import stream_branches as stream_branches
from exactfold.branches.counting.ways import count_opened as count_opened
from exactfold.branches.counting.ways import count_ways as count_ways
from exactfold.branches.periodic.certificate import periodic_certificate as periodic_certificate
from exactfold.branches.periodic.counting import count_periodic as count_periodic
from exactfold.branches.periodic.directions import count_directions as count_directions
from exactfold.branches.periodic.directions_result import BranchCrossing as BranchCrossing
from exactfold.branches.periodic.directions_result import DirectionsCount as DirectionsCount
from exactfold.branches.periodic.directions_result import ExactDirection as ExactDirection
from exactfold.branches.periodic.directions_result import RollingBranch as RollingBranch
from exactfold.branches.periodic.result import AlgebraicLine as AlgebraicLine
from exactfold.branches.periodic.result import HeightSpace as HeightSpace
from exactfold.branches.periodic.result import PeriodicBranch as PeriodicBranch
from exactfold.branches.periodic.result import PeriodicCount as PeriodicCount
from exactfold.branches.values.angles import FoldAngles as FoldAngles
from exactfold.branches.values.angles import fold_angles as fold_angles
from exactfold.branches.values.branch import Branch as Branch
from exactfold.branches.values.export import BranchExport as BranchExport
from exactfold.branches.values.export import export_branch as export_branch
from exactfold.branches.values.export import exported as exported
from exactfold.branches.values.lettered import Lettered as Lettered
from exactfold.branches.values.result import BranchCount as BranchCount
