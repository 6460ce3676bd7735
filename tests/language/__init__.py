"""Tests of what editors ask about a source."""
