from exactfold.assignment.certificate import match_certificate as match_certificate
from exactfold.assignment.refutation import Refutation as Refutation
from exactfold.assignment.search import Match as Match
from exactfold.assignment.search import Matched as Matched
from exactfold.assignment.search import match as match
