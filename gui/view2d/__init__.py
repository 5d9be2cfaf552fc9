"""The flat view: the pieces side by side, their sensors, and what a pointer does to them."""
