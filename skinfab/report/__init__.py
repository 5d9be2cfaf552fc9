"""What a person takes to the lab: report.json, report.html, preview.png."""
