"""Flat pieces: distortion, boundary first flattening, isometric refinement, overlap."""
