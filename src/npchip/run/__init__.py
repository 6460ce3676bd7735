"""The public chip, which runs programs on frames, and its results."""
