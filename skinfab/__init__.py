"""From a 3D model to a printed, calibrated soft sensor skin.

Arrays mean the same thing everywhere: ``V`` is (n, 3) float64 mm, ``F`` is (m, 3) int64,
``UV`` is (k, 2) float64 mm. Importing this package imports nothing heavy.
"""

__version__ = "0.1.0"
