"""The three-dimensional view: what each page sees of its robot and the ground, drawn by viser."""
