"""Bullet's power and cost of transport in two arrangements and two postures, as OpenSHC'20 VII measured them."""
