"""Motion capture to joint angles: markers from C3D and Vicon files, gaps, and the angle between two bones."""
