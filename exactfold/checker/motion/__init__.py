"""Certificates of motions and of loops."""
