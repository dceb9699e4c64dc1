"""The surface: curves divided, multiplied out and flattened to a mesh."""
