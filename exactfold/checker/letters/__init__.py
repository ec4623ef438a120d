"""Certificates about given mountains and valleys, of branches and of rigid panels."""
