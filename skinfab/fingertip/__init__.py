"""Fingertips that feel: each reads the frames of `skinfab.readout`, and has its published method and a better one side by side."""
