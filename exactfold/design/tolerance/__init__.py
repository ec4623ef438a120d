"""How far the vertices of a sheet may move before its ways to fold, or their letters, change."""
