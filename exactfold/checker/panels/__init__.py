"""Certificates that list all motions of a sheet of rigid panels."""
