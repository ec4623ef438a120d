"""The conveyor: from a problem by ends and roots to branches, block by block."""
