"""Finds candidates for the branches in floating point; nothing here is proved."""
