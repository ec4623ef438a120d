"""The first contact of faces along a motion, and proved bounds of fold angles."""
