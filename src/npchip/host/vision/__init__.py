"""The thesis's vision algorithms in plain Python and NumPy, each with its equations."""
