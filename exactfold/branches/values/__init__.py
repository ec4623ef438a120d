"""What a proved solution means: a branch with its signs, letters, heights and fold angles."""
