"""Exact drawings of the flat skin: SVG, DXF, OBJ with texture coordinates."""
