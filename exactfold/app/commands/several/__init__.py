"""`exactfold count` of several files."""
