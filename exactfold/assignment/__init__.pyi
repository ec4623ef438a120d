from exactfold.assignment.document import match_document as match_document
from exactfold.assignment.nearest import Nearest as Nearest
from exactfold.assignment.nearest import nearest_branches as nearest_branches
from exactfold.assignment.refutation import Refutation as Refutation
from exactfold.assignment.search import Match as Match
from exactfold.assignment.search import Matched as Matched
from exactfold.assignment.search import match as match
from exactfold.assignment.why import vertex_conflicts as vertex_conflicts
