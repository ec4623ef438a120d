"""The options of each command, with their help, and checks of which go together."""
