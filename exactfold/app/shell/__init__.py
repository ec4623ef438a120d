"""Code that all commands share: parameters, input files, errors, progress and interruptions."""
