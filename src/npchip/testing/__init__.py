"""Programs as tests: ``; run:`` and ``; expect:`` lines, goldens and differences."""
