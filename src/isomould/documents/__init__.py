"""What is delivered, before any file format: tables, drawings and the text on them."""
