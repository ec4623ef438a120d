"""All branches at scale: blocks of sign vectors, proved in floats, streamed to a file."""
