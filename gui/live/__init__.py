"""The tab that shows what sensors read while they read it: plots, contact lights, the joint's angle, recording."""
