"""The first contact of faces, and fold angles along a motion, enclosed."""
