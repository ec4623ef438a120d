"""Readers of drawings, one for each file format."""
