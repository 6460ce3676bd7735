"""What can be said of a program's cycles without running it."""
