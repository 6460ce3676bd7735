"""The thesis's host side: vision in plain Python, synthetic scenes, and two-camera rigs."""
