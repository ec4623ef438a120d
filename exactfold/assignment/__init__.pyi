from exactfold.assignment.assignment_list import AllAssignments as AllAssignments
from exactfold.assignment.assignment_list import Arc as Arc
from exactfold.assignment.assignment_list import Circle as Circle
from exactfold.assignment.assignment_list import Crossing as Crossing
from exactfold.assignment.certificate import match_certificate as match_certificate
from exactfold.assignment.circles import all_assignments as all_assignments
from exactfold.assignment.document import match_document as match_document
from exactfold.assignment.list_certificate import (
    assignments_certificate as assignments_certificate,
)
from exactfold.assignment.nearest import Nearest as Nearest
from exactfold.assignment.nearest import nearest_branches as nearest_branches
from exactfold.assignment.panel_match import PanelMatch as PanelMatch
from exactfold.assignment.panel_match import match_panels as match_panels
from exactfold.assignment.panel_refutation import PanelRefutation as PanelRefutation
from exactfold.assignment.refutation import Refutation as Refutation
from exactfold.assignment.rim_document import rim_match_document as rim_match_document
from exactfold.assignment.rim_match import RimMatch as RimMatch
from exactfold.assignment.rim_match import match_rim as match_rim
from exactfold.assignment.search import Match as Match
from exactfold.assignment.search import Matched as Matched
from exactfold.assignment.search import match as match
from exactfold.assignment.why import vertex_conflicts as vertex_conflicts
