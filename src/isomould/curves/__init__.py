"""Rail and generatrix: planar curves, analytic, spline or read from CAD, and how they turn."""
