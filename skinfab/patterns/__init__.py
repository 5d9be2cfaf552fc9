"""Sensor patterns: a small validated set of parameters plus an exact path, one file a pattern."""
