"""Why no branch with some vertex signs has given letters: what every search of letters shares."""
