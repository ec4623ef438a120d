"""Each vertex by itself: whether it folds with its letters, why not, and what to change."""
