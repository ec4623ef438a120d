"""Certificates of all branches and of single ones: written, read, and checked at scale."""
