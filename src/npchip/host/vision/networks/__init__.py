"""Small networks on the array: an integer model, its training, and how often it is right."""
