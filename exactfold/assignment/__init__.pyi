from exactfold.assignment.match import Match as Match
from exactfold.assignment.match import Matched as Matched
from exactfold.assignment.match import match as match
from exactfold.assignment.refutation import Refutation as Refutation
