from exactfold.exact.factors import factor_degrees as factor_degrees
from exactfold.exact.forms import QuadraticForm as QuadraticForm
from exactfold.exact.numbers import as_rational as as_rational
from exactfold.exact.numbers import format_rational as format_rational
