"""The report's pictures as SVG text: no plotting library, sharp at any size, readable without colour."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

INK, GRID, FIRST, SECOND = "#222", "#ccc", "#1c6fb0", "#b0471c"


def lens_plot(pixels: Array, means: Array, fields: tuple[int, int], size: tuple[int, int], enlarged: float) -> str:
    """Where corners were seen (n, 2), and the mean residual of each field (fields, 2) as an `enlarged` arrow."""
    width, height = size
    shown = pixels[:: max(1, len(pixels) // 3000)]
    dots = "".join(f'<circle cx="{x:.0f}" cy="{y:.0f}" r="2"/>' for x, y in shown)
    arrows = []
    for k, (dx, dy) in enumerate(means * enlarged):
        x, y = ((k % fields[1]) + 0.5) / fields[1] * width, ((k // fields[1]) + 0.5) / fields[0] * height
        arrows.append(f'<path d="M{x:.1f} {y:.1f}l{dx:.1f} {dy:.1f}"/><circle cx="{x:.1f}" cy="{y:.1f}" r="3"/>')
    lines = "".join(f'<path d="M{width * k / fields[1]:.1f} 0v{height}"/>' for k in range(1, fields[1]))
    lines += "".join(f'<path d="M0 {height * k / fields[0]:.1f}h{width}"/>' for k in range(1, fields[0]))
    return (
        f'<svg viewBox="0 0 {width} {height}" role="img" aria-label="corners seen and mean residuals">'
        f'<rect width="{width}" height="{height}" fill="#fff" stroke="{INK}"/>'
        f'<g stroke="{GRID}">{lines}</g><g fill="{FIRST}" fill-opacity="0.35">{dots}</g>'
        f'<g stroke="{SECOND}" fill="{SECOND}" stroke-width="3">{"".join(arrows)}</g></svg>'
    )


def scatter_plot(points: Array, reach: float, unit: str) -> str:
    """Residuals (n, 2) within +-reach, with circles at whole parts of it."""
    shown = points[:: max(1, len(points) // 4000)]
    scale = 190.0 / reach
    dots = "".join(
        f'<circle cx="{200 + x * scale:.1f}" cy="{200 + y * scale:.1f}" r="1.5"/>'
        for x, y in shown
        if abs(x) < reach and abs(y) < reach
    )
    circles = "".join(f'<circle cx="200" cy="200" r="{190 * k / 2}" fill="none"/>' for k in (1, 2))
    labels = "".join(
        f'<text x="{204 + 190 * k / 2:.0f}" y="196" font-size="13">{reach * k / 2:.2g} {unit}</text>' for k in (1,)
    )
    return (
        f'<svg viewBox="0 0 400 400" role="img" aria-label="residuals"><rect width="400" height="400" fill="#fff"/>'
        f'<g stroke="{GRID}">{circles}<path d="M10 200h380M200 10v380"/></g>'
        f'<g fill="{FIRST}" fill-opacity="0.4">{dots}</g>{labels}</svg>'
    )


def bar_plot(values: Sequence[float], unit: str, label: str) -> str:
    """One bar per view, with the highest value written beside the axis."""
    top = max([*values, 1e-12])
    step = 580.0 / max(len(values), 1)
    bars = "".join(
        f'<rect x="{60 + k * step:.1f}" y="{180 - 160 * value / top:.1f}" width="{max(step * 0.8, 0.5):.2f}" '
        f'height="{160 * value / top:.1f}"/>'
        for k, value in enumerate(values)
    )
    return (
        f'<svg viewBox="0 0 650 210" role="img" aria-label="{label}"><rect width="650" height="210" fill="#fff"/>'
        f'<g fill="{FIRST}">{bars}</g><path d="M58 15V180H645" fill="none" stroke="{INK}"/>'
        f'<text x="2" y="26" font-size="13">{top:.3g}</text><text x="2" y="42" font-size="13">{unit}</text>'
        f'<text x="60" y="200" font-size="13">{label}</text></svg>'
    )


def histogram_plot(values: Array, label: str) -> str:
    """How often each whitened error came, over the bell curve it should be."""
    edges = np.linspace(-5.0, 5.0, 61)
    counts, _ = np.histogram(values, edges)
    share = counts / max(1, len(values)) / (edges[1] - edges[0])
    top = max(0.45, float(share.max(initial=0.0)))
    middles = 0.5 * (edges[1:] + edges[:-1])
    bars = "".join(
        f'<rect x="{325 + 60 * x - 5:.1f}" y="{180 - 160 * y / top:.1f}" width="9" height="{160 * y / top:.1f}"/>'
        for x, y in zip(middles, share, strict=True)
    )
    bell = np.exp(-0.5 * middles**2) / np.sqrt(2.0 * np.pi)
    curve = "L".join(f"{325 + 60 * x:.1f} {180 - 160 * y / top:.1f}" for x, y in zip(middles, bell, strict=True))
    ticks = "".join(f'<text x="{320 + 60 * k}" y="200" font-size="13">{k}</text>' for k in range(-5, 6))
    return (
        f'<svg viewBox="0 0 650 230" role="img" aria-label="{label}"><rect width="650" height="230" fill="#fff"/>'
        f'<g fill="{FIRST}">{bars}</g><path d="M{curve}" fill="none" stroke="{SECOND}" stroke-width="2"/>'
        f'<path d="M20 180H630" stroke="{INK}"/>{ticks}<text x="20" y="222" font-size="13">{label}</text></svg>'
    )
