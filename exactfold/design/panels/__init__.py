"""Whether rigid panels start to fold with given mountains and valleys."""
