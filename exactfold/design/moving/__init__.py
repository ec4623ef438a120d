"""Moving the vertices of a sheet so that it folds as it is wanted to."""
