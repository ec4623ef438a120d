"""Certificates of mountains and valleys: of branches and of rigid panels."""
