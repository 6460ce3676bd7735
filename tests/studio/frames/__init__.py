"""The page's frames, asked in Node and in browsers."""
