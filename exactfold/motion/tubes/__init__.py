"""Proofs of curves: tubes, which hold one configuration for each parameter, and their links."""
