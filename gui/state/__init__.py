"""What the window shows, without a window: the document, its history, what is selected, what is wrong."""
