"""Where sensors lie on the flat skin: poses, checks, automatic placement, wrap strain."""
