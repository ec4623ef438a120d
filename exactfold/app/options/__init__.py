"""The options of each command, with their help, and checks of which go together.

Typer reads the annotations at every start of the command. So these modules do not turn them into
strings, which would be compiled each time, and the dataclasses have no methods that nothing uses.
"""
