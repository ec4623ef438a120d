"""The pieces of the solutions of a convex sheet with any border, and where they are joined."""
