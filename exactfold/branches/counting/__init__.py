"""Counting branches: candidates are solved for, proved, and turned into branches."""
