"""Pictures of crease patterns, of ways to fold them, and of sheets in space."""
