"""A robot's joint that follows a human's: control laws, the gain they stand, the loop in real time."""
