"""Certificates of all motions of a sheet of rigid panels."""
