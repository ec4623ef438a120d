"""Writes FOLD files that keep exact coordinates."""
