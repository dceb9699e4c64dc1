"""Bytes: one module per file format, and the folder that is published by one rename."""
