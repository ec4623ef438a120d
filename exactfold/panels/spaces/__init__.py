"""Linear spaces and cones of motions, for vertices with any number of folds."""
