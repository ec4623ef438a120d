"""All mountain-valley assignments of a convex sheet with five corners."""
