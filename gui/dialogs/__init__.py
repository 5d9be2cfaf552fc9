"""Windows that ask something before work goes on."""
