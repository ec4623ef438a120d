"""The exact equations of a sheet, and the gauge in which they are written."""
