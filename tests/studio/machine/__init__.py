"""Tests of the chip of the page."""
