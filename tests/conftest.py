"""Puts this folder on the import path, so that all tests share `sheets`."""
