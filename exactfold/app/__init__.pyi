from exactfold.app import report as report
from exactfold.app import viewer as viewer
