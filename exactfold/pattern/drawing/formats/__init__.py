"""Readers of drawings, one for each format of files."""
