"""How good a mesh is, whoever made it, and the families of meshes that a design can be compared with."""
