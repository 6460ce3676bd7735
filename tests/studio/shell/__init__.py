"""Tests of what joins the parts of the page."""
