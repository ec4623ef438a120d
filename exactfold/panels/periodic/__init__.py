"""Tessellations of rigid panels: periodic motions at the flat state, and which of them fold."""
