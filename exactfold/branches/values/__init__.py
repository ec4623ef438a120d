"""What the solutions mean."""
