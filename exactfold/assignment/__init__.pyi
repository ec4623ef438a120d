from exactfold.assignment.panel_match import PanelMatch as PanelMatch
from exactfold.assignment.panel_match import match_panels as match_panels
from exactfold.assignment.panel_refutation import PanelRefutation as PanelRefutation
from exactfold.assignment.refutation import Refutation as Refutation
from exactfold.assignment.search import Match as Match
from exactfold.assignment.search import Matched as Matched
from exactfold.assignment.search import match as match
