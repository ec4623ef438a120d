"""Panels as plates of some thickness, and the contacts of such plates."""
