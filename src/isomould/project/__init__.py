"""The project file: schema and loading."""
