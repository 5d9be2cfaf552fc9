"""The simulated finger, and logs of it."""
