"""Certificates of branches: all, one, or the components that they form."""
