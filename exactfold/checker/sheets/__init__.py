"""The sheet in a certificate, rebuilt from its vertices and faces, and its equations."""
