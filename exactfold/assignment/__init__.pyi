from exactfold.assignment.refutation import Refutation as Refutation
from exactfold.assignment.search import Match as Match
from exactfold.assignment.search import Matched as Matched
from exactfold.assignment.search import match as match
