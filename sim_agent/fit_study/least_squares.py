"""Polynomials of roughness and step height through the best gaits, of the degree that predicts best (eqs. 9-11).

As in the paper's Fig. 5, stiffness and frequency never rise with rougher ground, and the stride height never falls:
what a few grounds seem to say against it is no more than their noise.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.adaptation import safe_gait
from sim_agent.fit_study.best import BestGait
from weaver_shared.config.adaptation import AdaptationConfig

Array = NDArray[np.float64]

PARAMETERS = ("virtual_stiffness", "stride_frequency", "stride_height")
POLYNOMIALS = {name: f"{name.split('_')[1]}_polynomial" for name in PARAMETERS}
TERMS: dict[str, tuple[tuple[int, ...], ...]] = {
    "virtual_stiffness": ((0,), (0, 1), (0, 1, 2), (0, 1, 2, 3)),
    "stride_frequency": ((0,), (0, 1), (0, 1, 2)),
    "stride_height": ((0,), (0, 1), (0, 2), (0, 1, 2)),
}
"""Subsets of each polynomial's coefficients, of which the data choose one."""
LEAST_SPREAD = 0.08
"""Of a parameter's range: no ground's best gait is known better than that."""
HELD = 0.02
"""Times that, for the safe gait: so near do the polynomials come to it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted:
    """Coefficients as `AdaptationConfig` takes them, and how they fit; errors in the parameter's unit."""

    name: str
    coefficients: tuple[float, ...]
    terms: tuple[int, ...]  # those used; the other coefficients are 0
    residual: float  # root mean square at the grounds
    predicted: float  # root mean square at each ground, fitted without it


def fit(bests: list[BestGait], adaptation: AdaptationConfig) -> list[Fitted]:
    """One `Fitted` a parameter from the grounds on which some gait passed.

    At r = h = 1, the answer for unknown ground, the polynomials are held to the safe gait as it is: no trial says what
    is safe where nothing is known.
    """
    passed = [best for best in bests if best.passed]
    safe = safe_gait(adaptation)
    r = np.array([best.roughness for best in passed] + [1.0])
    h = np.array([best.step_height for best in passed] + [1.0])
    result = []
    for k, name in enumerate(PARAMETERS):
        bounds = getattr(adaptation, name)
        least = LEAST_SPREAD * (bounds.upper - bounds.lower)
        values = np.array([best.parameters[k] for best in passed] + [safe[name]])
        spreads = np.append(np.hypot([best.spread[k] for best in passed], least), HELD * least)
        result.append(_fit(name, _design(name, r, h), values, spreads))
    return result


def _design(name: str, r: Array, h: Array) -> Array:
    """Columns of the polynomial's terms: powers of r, or 1, h and r."""
    if name == "stride_height":
        return np.column_stack([np.ones_like(r), h, r])
    return np.vander(r, len(TERMS[name]), increasing=True)


def _fit(name: str, design: Array, values: Array, spreads: Array) -> Fitted:
    errors = {
        terms: _predicted(design[:, terms], values, spreads) for terms in TERMS[name] if len(terms) < len(values) - 1
    }
    if not errors:
        errors = {(0,): float("nan")}
    solved = {terms: _filled(design, terms, values, spreads) for terms in errors}
    terms = min(errors, key=lambda one: (not _goes_one_way(name, solved[one]), errors[one]))
    coefficients = solved[terms]
    residual = values[:-1] - (design @ coefficients)[:-1]
    return Fitted(
        name=name,
        coefficients=tuple(float(f"{value:.4g}") for value in coefficients),
        terms=terms,
        residual=float(np.sqrt(np.mean(residual**2))) if len(residual) else float("nan"),
        predicted=errors[terms],
    )


def _filled(design: Array, terms: tuple[int, ...], values: Array, spreads: Array) -> Array:
    """All coefficients of the polynomial, those but `terms` zero."""
    coefficients = np.zeros(design.shape[1])
    coefficients[list(terms)] = _solve(design[:, terms], values, spreads)
    return coefficients


def _goes_one_way(name: str, coefficients: Array) -> bool:
    """Whether the polynomial never rises with rougher ground; of the stride height, never falls."""
    if name == "stride_height":
        return bool((coefficients[1:] >= 0.0).all())
    return bool((np.diff(np.polynomial.Polynomial(coefficients)(np.linspace(0.0, 1.0, 101))) <= 0.0).all())


def _predicted(design: Array, values: Array, spreads: Array) -> float:
    """Root mean square error at every ground when it alone is left out; the safe gait is always in."""
    errors = []
    for k in range(len(values) - 1):
        kept = np.arange(len(values)) != k
        errors.append(values[k] - design[k] @ _solve(design[kept], values[kept], spreads[kept]))
    return float(np.sqrt(np.mean(np.square(errors))))


def _solve(design: Array, values: Array, spreads: Array) -> Array:
    return np.asarray(np.linalg.lstsq(design / spreads[:, None], values / spreads, rcond=None)[0], dtype=np.float64)


def adapted(adaptation: AdaptationConfig, fitted: list[Fitted]) -> AdaptationConfig:
    """The settings with the fitted polynomials in place of their own."""
    found = {POLYNOMIALS[one.name]: one.coefficients for one in fitted}
    return AdaptationConfig.model_validate({**adaptation.model_dump(), **found})
