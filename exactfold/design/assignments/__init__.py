"""Which branches have given mountains and valleys, and why the others have not."""
