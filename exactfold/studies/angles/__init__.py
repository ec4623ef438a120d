"""The angles between the branches of random squares, compared with the sentences of the paper."""
