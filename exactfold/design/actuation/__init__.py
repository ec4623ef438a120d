"""Torques that drive a sheet from the flat state along one branch and not along its rivals."""
