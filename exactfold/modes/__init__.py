"""First-order motions of sheets of rigid panels: which exist, and which of them truly fold."""
