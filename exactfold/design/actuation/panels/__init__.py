"""Torques that drive a sheet of rigid panels along one of its ways and not along the others."""
