"""Numbers and linear algebra over Q."""
