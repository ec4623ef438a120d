"""The connected components of the solutions of a convex sheet of any boundary, and their joints."""
