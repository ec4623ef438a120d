"""Modules that every room may use: verdicts, progress, processes, schemas, plurals."""
