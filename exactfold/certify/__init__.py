"""From candidates to proofs."""
