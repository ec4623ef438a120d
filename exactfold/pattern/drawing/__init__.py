"""Crease patterns as people draw them: file formats, repair, exact coordinates."""
