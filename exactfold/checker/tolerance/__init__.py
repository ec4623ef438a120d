"""Certificates of how far the vertices of a sheet may move."""
