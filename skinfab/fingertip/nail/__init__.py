"""A motor shakes the nail, and what the nail answers tells which edge or pin the bare fingertip touches, where and how hard."""
