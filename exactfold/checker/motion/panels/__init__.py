"""Certificates of motions of rigid panels."""
