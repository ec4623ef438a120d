"""What each command takes: its options once, with their help, and which go together."""
