"""The tool path of a piece: what the head does when, seen before it is printed."""
