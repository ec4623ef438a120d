"""Certifiers: they prove which candidates are roots, and whether all roots are found."""
