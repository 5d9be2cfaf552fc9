"""Measurements of calibration and control, for `skinfab bench`."""
