"""Triangle meshes: the model, reading and writing, inspection, repair, units."""
