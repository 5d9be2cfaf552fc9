"""What stands beside the views: lists, forms, the status bar. Each panel listens to the session and knows no other panel."""
