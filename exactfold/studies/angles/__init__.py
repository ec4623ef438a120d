"""Angles between the branches of random squares, and what the paper says of them."""
