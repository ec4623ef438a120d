"""The connected components of the solutions of a convex sheet with any border, and their joints."""
