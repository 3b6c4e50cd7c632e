"""The operator's console: page, three-dimensional scene and link to the robots."""
