from exactfold.solve.algebraic.exact_solution import ExactSolution as ExactSolution
from exactfold.solve.algebraic.exact_solution import RootClass as RootClass
from exactfold.solve.algebraic.from_roots import (
    parametrisation_from_roots as parametrisation_from_roots,
)
from exactfold.solve.algebraic.groebner_bases import groebner as groebner
from exactfold.solve.algebraic.groebner_bases import quotient_algebra as quotient_algebra
from exactfold.solve.algebraic.hilbert import dimension_and_degree as dimension_and_degree
from exactfold.solve.algebraic.quotient import QuotientAlgebra as QuotientAlgebra
from exactfold.solve.certify.ball_newton import interval_newton as interval_newton
from exactfold.solve.certify.box import IsolatingBox as IsolatingBox
from exactfold.solve.certify.box import Uncertified as Uncertified
from exactfold.solve.certify.exact_krawczyk import krawczyk as krawczyk
from exactfold.solve.certify.isolation import Isolation as Isolation
from exactfold.solve.certify.isolation import isolate as isolate
from exactfold.solve.numeric.candidates import Candidates as Candidates
from exactfold.solve.numeric.homotopy import homotopy as homotopy
from exactfold.solve.numeric.newton import newton as newton
from exactfold.solve.numeric.popping import popping as popping
