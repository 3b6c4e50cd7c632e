"""Camera geometry shared by odometry and perception."""
