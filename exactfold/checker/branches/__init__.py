"""Certificates of all branches, of one branch, and of the pieces that solutions form."""
