"""Why no branch with given vertex signs has given letters: the parts that all searches share."""
