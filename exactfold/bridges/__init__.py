"""The same problem in the languages of other programs."""
