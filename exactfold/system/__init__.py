"""The exact polynomial system with its gauge written down."""
