"""What every room may use: verdicts, progress, processes, schemas, plurals."""
