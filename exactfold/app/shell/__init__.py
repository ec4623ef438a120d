"""What all commands share: parameters, files of numbers, errors, progress and interruptions."""
