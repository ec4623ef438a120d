"""Triangulations: of points, of random squares, and of panels."""
