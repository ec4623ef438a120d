"""The report of a study: one HTML file with figures that Matplotlib draws."""
