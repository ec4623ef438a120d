"""Everything that studies share: recipes, journals of rows, processes, statistics, and files."""
