"""G-code: neutral programs, printer profiles, emitters, parsers, checks and estimates."""
