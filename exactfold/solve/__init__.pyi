from exactfold.solve.candidates import Candidates as Candidates
from exactfold.solve.homotopy_ends import homotopy as homotopy
from exactfold.solve.newton_ends import newton as newton
from exactfold.solve.popping_ends import popping as popping
