"""The engines that execute programs."""
