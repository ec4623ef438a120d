"""Motions from the flat state back to it, and the graph that they form."""
