"""Measurements of the project beside its peers: each ends in a table, a chart and a sentence (`skinfab bench`)."""
