"""Certificates about flat-folded states of rigid panels: orders of their layers."""
