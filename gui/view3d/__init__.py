"""The object in space: a z-buffer drawn into a Tk image, quick enough to turn 85,000 triangles with the pointer."""
