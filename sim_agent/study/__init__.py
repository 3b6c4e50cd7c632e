"""Every robot in every gait, walked without console, cameras or odometry, and judged by the truth."""
