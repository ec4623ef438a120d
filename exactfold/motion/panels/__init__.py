"""Motions of sheets of rigid panels."""
