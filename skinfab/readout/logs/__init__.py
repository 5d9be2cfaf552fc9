"""Recordings in files that other tools read and write: CSV tables, MCAP, and bags of ROS 1 and ROS 2, without ROS.

What belongs here: one module a format, what the formats with messages have in common, and `log`, which knows a file by
its content. What the columns mean is for others.
"""
