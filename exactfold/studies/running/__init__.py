"""What all studies share: recipes, the journal of rows, processes, statistics, and files."""
