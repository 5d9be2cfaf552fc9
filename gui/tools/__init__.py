"""What clicks and drags in the views do, one file a family of tools."""
