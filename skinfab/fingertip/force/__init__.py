"""A fingertip on a six-axis force/torque sensor: contact point, slip, texture, centre of gravity, shape."""
