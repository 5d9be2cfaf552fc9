"""Strain sensors: the curve from angle to reading, models of hysteresis for the way back, fitting, files and figures."""
