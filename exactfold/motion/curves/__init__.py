"""Curves of configurations, followed in floating point; nothing is proved here."""
