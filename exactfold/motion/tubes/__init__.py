"""Proofs of curves: tubes with exactly one configuration for each parameter, and their links."""
