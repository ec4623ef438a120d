"""The command line: it reads options, calls commands, and returns their exit codes."""
