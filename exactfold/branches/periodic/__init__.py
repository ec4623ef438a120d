"""Periodic sheets: all branches, and linear spaces of pleats, for one direction."""
