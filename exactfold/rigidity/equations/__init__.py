"""The exact equations of a sheet, with its gauge written down."""
