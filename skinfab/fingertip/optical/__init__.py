"""An optical fingertip: a camera watches the pins of a soft dome, whose pattern tells the edge that it lies on."""
