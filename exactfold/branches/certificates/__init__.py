"""Writes, reads and checks certificates of all branches and of single branches."""
