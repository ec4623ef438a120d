"""True motions of periodic sheets that roll up on cylinders."""
