from exactfold.problem.branch_system import BranchSystem as BranchSystem
from exactfold.problem.branch_system import Chart as Chart
from exactfold.problem.gauge import Gauge as Gauge
from exactfold.problem.perturbation import perturbed as perturbed
from exactfold.problem.problem import Problem as Problem
from exactfold.problem.quadratic import QuadraticSystem as QuadraticSystem
