"""Sheets that repeat in two directions: the cell, its files, and random cells."""
