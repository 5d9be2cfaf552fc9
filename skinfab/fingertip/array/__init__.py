"""A capacitive array of 8 x 8 tactels round a fingertip: where it is pressed, how hard, along which line, and what moves."""
