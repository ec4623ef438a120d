"""Curves of configurations that are followed in floating point; nothing is proved here."""
