"""The sheet that was meant: relations of angles that a drawing nearly has, made exact."""
