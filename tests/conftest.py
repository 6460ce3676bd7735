"""Hypothesis profiles: "quick" while working, "thorough" with NPCHIP_PROFILE=thorough."""

from __future__ import annotations

import os

from hypothesis import settings

settings.register_profile("quick", deadline=None, max_examples=60)
settings.register_profile("thorough", deadline=None, max_examples=10_000)
settings.load_profile(os.environ.get("NPCHIP_PROFILE", "quick"))
