"""Crease patterns: the validated type, where patterns come from, and their files."""
