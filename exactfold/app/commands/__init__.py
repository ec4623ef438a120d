"""The commands: each module answers one command, whose options are in `app/options`."""
