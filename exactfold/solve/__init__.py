"""Candidates for the zeros of the branch system, exact or approximate."""
