"""The sheet of a certificate, rebuilt from its vertices and its faces or edges; its equations."""
