"""From a device, a log or a simulator to frames of numbers: one interface under every sensor of the project.

What belongs here: what a frame and a stream are, how bytes become frames, sources and logs, recording, the bridge's
arithmetic, and filters of signals. What the numbers mean is for `calibration` and `skinfab.fingertip`.
"""
