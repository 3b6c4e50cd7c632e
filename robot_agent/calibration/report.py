"""The report of a calibration: one list of sections, written as Markdown and as a web page with plots."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from robot_agent.calibration.guidance import COVER, EYES, Wish
from robot_agent.calibration.inertial_calibration import InertialEstimate
from robot_agent.calibration.lens import NAMES
from robot_agent.calibration.plots import bar_plot, histogram_plot, lens_plot, scatter_plot
from robot_agent.calibration.rig_batch import RigEstimate
from robot_agent.calibration.sightings import Session
from robot_agent.calibration.verdicts import Verdict, field_means, pattern_of
from weaver_shared.transforms import rotation_log

STYLE = (
    "body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222}"
    "table{border-collapse:collapse}td,th{padding:.2rem .8rem;border-bottom:1px solid #ccc;text-align:right}"
    "td:first-child,th:first-child{text-align:left}svg{max-width:100%;height:auto;border:1px solid #ccc}"
    ".verdict{padding:.6rem 1rem;border-left:.4rem solid;font-weight:600}"
    ".good{border-color:#2a7}.bad{border-color:#c33}"
    "@media(max-width:40rem){table{display:block;overflow-x:auto}h1{font-size:1.5rem}body{margin:.5rem auto}}"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    title: str
    lines: tuple[str, ...] = ()
    head: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    plots: tuple[tuple[str, str], ...] = field(default=())  # caption and SVG


def write_report(title: str, verdict: Verdict, sections: Sequence[Section], folder: Path) -> None:
    """report.md and report.html in `folder`."""
    (folder / "report.md").write_text(as_markdown(title, verdict, sections), encoding="utf-8")
    (folder / "report.html").write_text(as_html(title, verdict, sections), encoding="utf-8")


def as_markdown(title: str, verdict: Verdict, sections: Sequence[Section]) -> str:
    text = [f"# {title}", f"**{_capital(str(verdict))}.**"]
    for section in sections:
        text.append(f"## {section.title}")
        text += [f"- {line}" for line in section.lines]
        if section.rows:
            text.append("")
            text.append("| " + " | ".join(section.head) + " |")
            text.append("|---" * len(section.head) + "|")
            text += ["| " + " | ".join(row) + " |" for row in section.rows]
        text.append("")
    return "\n".join(text).rstrip() + "\n"


def as_html(title: str, verdict: Verdict, sections: Sequence[Section]) -> str:
    body = [f"<h1>{html.escape(title)}</h1>"]
    body.append(f'<p class="verdict {"good" if verdict.usable else "bad"}">{html.escape(_capital(str(verdict)))}.</p>')
    for section in sections:
        body.append(f"<h2>{html.escape(section.title)}</h2>")
        if section.lines:
            body.append("<ul>" + "".join(f"<li>{html.escape(line)}</li>" for line in section.lines) + "</ul>")
        if section.rows:
            head = "".join(f"<th>{html.escape(cell)}</th>" for cell in section.head)
            rows = "".join(
                "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in section.rows
            )
            body.append(f"<table><tr>{head}</tr>{rows}</table>")
        body += [
            f"<figure>{svg}<figcaption>{html.escape(caption)}</figcaption></figure>" for caption, svg in section.plots
        ]
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title>'
        f"<style>{STYLE}</style>{''.join(body)}</html>\n"
    )


def camera_sections(estimate: RigEstimate, session: Session, wished: Sequence[Wish]) -> list[Section]:
    rig = estimate.rig
    sections = [
        Section(
            title="Views",
            lines=(
                f"{len(session.views)} of {session.pictures} pictures show the target",
                *(f"{wish.what}: {'good' if wish.met else wish.advice}" for wish in wished),
            ),
            plots=(
                ("Residual of each view (root mean square).", bar_plot(view_rms(estimate), "px", "views in order")),
            ),
        )
    ]
    for eye, model in enumerate(rig.models):
        rows = estimate.table.eye == eye
        errors, used = estimate.residuals[rows], estimate.used[rows]
        rms = float(np.sqrt((errors**2).sum(axis=1).mean()))
        means, _ = field_means(estimate, eye)
        sigma = estimate.intrinsics_sigma[eye]
        sections.append(
            Section(
                title=f"{_capital(EYES[eye])} eye" if rig.eyes > 1 else "Camera",
                lines=(
                    f"pinhole with {model} distortion, {rig.sizes[eye][0]} x {rig.sizes[eye][1]} px",
                    f"{int(rows.sum())} corners, {int((~used).sum())} left out as wild; reprojection error "
                    f"{rms:.3f} px (root mean square)",
                    f"residuals of one part of the picture lean by {pattern_of(estimate, eye):.3f} px together",
                ),
                head=("parameter", "value", "standard deviation"),
                rows=tuple(
                    (name, f"{value:.6g}", f"{deviation:.2g}")
                    for name, value, deviation in zip(NAMES[model], rig.intrinsics[eye], sigma, strict=False)
                ),
                plots=(
                    (
                        "Where corners were seen (dots) and their mean residual in each field, 100 times enlarged.",
                        lens_plot(estimate.table.pixel[rows], means, COVER, rig.sizes[eye], 100.0),
                    ),
                    ("Residuals of all corners.", scatter_plot(errors, 5.0 * estimate.sigma, "px")),
                ),
            )
        )
    if rig.eyes > 1:
        place, sigma = rig.eye_from_first[1], np.sqrt(np.diag(estimate.covariance))[-6:]
        turn = np.degrees(rotation_log(place.rotation))
        sections.append(
            Section(
                title="Right eye from the left",
                lines=(f"baseline {1e3 * rig.baseline:.3f} mm",),
                head=("axis of the left eye", "translation, mm", "rotation, degrees"),
                rows=tuple(
                    (
                        axis,
                        f"{1e3 * place.position[k]:.3f} ± {1e3 * sigma[3 + k]:.3f}",
                        f"{turn[k]:.4f} ± {np.degrees(sigma[k]):.4f}",
                    )
                    for k, axis in enumerate("xyz")
                ),
            )
        )
    return sections


def inertial_sections(estimate: InertialEstimate) -> list[Section]:
    place = estimate.imu_from_camera
    turn = np.degrees(rotation_log(place.rotation))
    noise = {
        "corners": (estimate.corner_errors, "px"),
        "gyro": (estimate.gyro_errors, "of imu.yaml's noise"),
        "accelerometer": (estimate.accel_errors, "of imu.yaml's noise"),
    }
    return [
        Section(
            title="Camera in the IMU's frame",
            lines=(
                f"{estimate.pictures} pictures; IMU time is picture stamp plus {1e3 * estimate.time_offset:.4f} ms "
                f"(± {1e6 * estimate.time_offset_sigma:.1f} us)",
                f"by the accelerometer, the target has {100 * estimate.target_scale:.2f} % of its file's size "
                f"(± {100 * estimate.target_scale_sigma:.2f})",
            ),
            head=("axis", "translation, mm", "rotation vector, degrees", "rotation sigma, degrees"),
            rows=tuple(
                (
                    axis,
                    f"{1e3 * place.position[k]:.3f} ± {1e3 * estimate.position_sigma[k]:.3f}",
                    f"{turn[k]:.4f}",
                    f"{np.degrees(estimate.rotation_sigma[k]):.4f}",
                )
                for k, axis in enumerate("xyz")
            ),
        ),
        Section(
            title="IMU",
            head=("axis", "gyro bias, rad/s", "accelerometer bias, m/s^2", "gravity in the target's frame, m/s^2"),
            rows=tuple(
                (
                    axis,
                    f"{estimate.gyro_bias[k]:.5f} ± {estimate.bias_sigma[k]:.5f}",
                    f"{estimate.accel_bias[k]:.4f} ± {estimate.bias_sigma[3 + k]:.4f}",
                    f"{estimate.gravity_in_target[k]:.4f}",
                )
                for k, axis in enumerate("xyz")
            ),
        ),
        Section(
            title="Residuals",
            head=("of", "mean length", "standard deviation", "unit"),
            rows=tuple(
                (name, f"{np.linalg.norm(errors, axis=1).mean():.3f}", f"{errors.std():.3f}", unit)
                for name, (errors, unit) in noise.items()
            ),
            plots=(
                ("Gyro.", histogram_plot(estimate.gyro_errors.ravel(), "gyro residuals in sigmas of imu.yaml")),
                ("Accelerometer.", histogram_plot(estimate.accel_errors.ravel(), "accelerometer residuals in sigmas")),
                ("Corners.", scatter_plot(estimate.corner_errors, 5.0 * float(estimate.corner_errors.std()), "px")),
            ),
        ),
    ]


def view_rms(estimate: RigEstimate) -> list[float]:
    """Root mean square residual of each view, px."""
    squares = (estimate.residuals**2).sum(axis=1)
    views = len(estimate.first_from_target)
    counts = np.maximum(np.bincount(estimate.table.view, minlength=views), 1)
    return [float(x) for x in np.sqrt(np.bincount(estimate.table.view, weights=squares, minlength=views) / counts)]


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
