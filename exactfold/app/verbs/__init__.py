"""What Python users call: one function for each thing that can be done with any sheet."""
