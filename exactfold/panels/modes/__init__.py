"""Elementary modes: motions of parts whose vertices have at most four folds."""
