"""Evidence, written and read back: listings, streamed files, single branches."""
