"""Write the table of docs/control.md, what becomes of the figures without each term: ``python calibration/scripts/finger_ablation.py``."""

import sys
from dataclasses import astuple

from calibration.control.ablation import TERMS, figures_without

if __name__ == "__main__":
    for term in TERMS:
        figures = " | ".join(f"{figure:.3g}" for figure in astuple(figures_without(term)))
        sys.stdout.write(f"| {term} | {figures} |\n")
