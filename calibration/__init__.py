"""From logged resistances to joint angles and contacts: strain-angle curves, the joint controller, contact detection.

What belongs here: fitting and applying calibrations to logged or live signals, the scripts that a lab
runs for it, and the logs they are shown on. How signals reach the computer is `skinfab.readout`;
this package imports `skinfab`, and nothing in `skinfab` but its command line imports it.
"""
