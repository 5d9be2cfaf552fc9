"""Contact detection: resting levels, false alarms, events, tables, the simulator they are judged on."""
