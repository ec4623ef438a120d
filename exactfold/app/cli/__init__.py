"""The command line: options and exit codes, and nothing decided."""
