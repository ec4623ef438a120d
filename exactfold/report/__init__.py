"""What people read: answers in plain words and tables, with rich."""

from exactfold.report.actuation import actuation_report
from exactfold.report.angles_plot import angles_plot
from exactfold.report.batch import batch_report
from exactfold.report.branch import branch_report, branch_row, branches_report, export_report
from exactfold.report.count import count_report
from exactfold.report.info import examples_report, expectation, info_report, panels_info
from exactfold.report.motion import motion_report
from exactfold.report.motions import motions_report
from exactfold.report.panels import panels_report
from exactfold.report.stills import motion_stills
from exactfold.report.terminal import console, show

__all__ = [
    "actuation_report",
    "angles_plot",
    "batch_report",
    "branch_report",
    "branch_row",
    "branches_report",
    "console",
    "count_report",
    "examples_report",
    "expectation",
    "export_report",
    "info_report",
    "motion_report",
    "motion_stills",
    "motions_report",
    "panels_info",
    "panels_report",
    "show",
]
