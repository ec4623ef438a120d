"""One vertex of a sheet of panels: its folds, its motions, and its letters."""
