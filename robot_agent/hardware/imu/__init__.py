"""MicroStrain IMUs: their bytes, their clock and their streams."""
