"""The functions for Python users: one for each thing that can be done with a sheet."""
