"""The course of ``npchip learn``: exercises, a learner's progress, checks and hints."""
