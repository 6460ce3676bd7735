"""The debugger: its language, a session without a screen, scripts, and the screen."""
