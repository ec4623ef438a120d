"""Drawings of crease patterns as people have them: formats, repair, exact coordinates."""
