"""Section about the endoscope: how often and how late pictures came, and the contact that was seen beside the truth."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from saras.recording import Session, Topic
from saras.report.parts import both_sides, chart, table
from saras.report.verdicts import SIDES, Findings

Array = npt.NDArray[np.float64]

#: Rates that these nodes say in /diagnostics, and the names of what they do.
SAID = (("endoscope_sim", "pictures drawn"), ("endoscope_capture", "pictures captured"), ("stereo_contact", "contact"))
AT_CONTACT_M = 1e-4  #: the truth is a contact from this depth on
#: Farther apart than this a sample of the truth says nothing about one that was seen [s].
APART_S = 0.06


def vision(session: Session, found: Findings) -> str:
    """Rates and ages; depth and force over time. What was not recorded is said."""
    values = _diagnostics(session)
    rows = [*_rates(values), *_videos(session), *_overlays(values)]
    html = table(
        ["what", "mean [Hz]", "wanted [Hz]", "longest gap [ms]", "age p50 [ms]", "age p99 [ms]", "worst [ms]"], rows
    )
    seen = any(session.topic(f"/contact/{side}") is not None for side in SIDES)
    if not rows and not seen:
        return "<p class='note'>No endoscope was recorded.</p>"
    note = (
        "<p class='note'>Rates of nodes: mean of what they said each second once they had begun. Ages: of the overlay "
        "when it was published, since its picture was taken; of a recorded picture when the video took it.</p>"
    )
    if not seen:
        return html + note + "<p class='note'>Contact by vision was not recorded.</p>"
    return html + note + both_sides(lambda side: _contact(session, found, side))


def _diagnostics(session: Session) -> dict[str, list[dict[str, str]]]:
    """Key and value of each report of each node, by its name."""
    topic = session.topic("/diagnostics")
    found: dict[str, list[dict[str, str]]] = {}
    for statuses in topic["status"] if topic is not None else ():
        for status in statuses:
            found.setdefault(status.name.strip("/"), []).append({pair.key: pair.value for pair in status.values})
    return found


def _rates(values: dict[str, list[dict[str, str]]]) -> list[list[Any]]:
    rows = []
    for node, what in SAID:
        said = [float(report["rate_hz"]) for report in values.get(node, ()) if "rate_hz" in report]
        begun = next((i for i, rate in enumerate(said) if rate > 0.0), len(said))
        if not said:
            continue
        wanted = values[node][-1].get("wanted_hz")
        mean = f"{np.mean(said[begun:]):.1f}" if begun < len(said) else "0.0"
        rows.append([what, mean, wanted or "", "", "", "", ""])
    return rows


def _videos(session: Session) -> list[list[Any]]:
    rows = []
    for side in SIDES:
        topic = session.topic(f"/recorder/video/{side}")
        if topic is None or len(topic) < 2:
            continue
        age_ms = 1e3 * (topic.t_received - topic.t)
        gaps = np.diff(topic.t)
        rate = (len(topic) - 1) / max(float(topic.t[-1] - topic.t[0]), 1e-9)
        numbers = (rate, 1e3 * gaps.max(), *np.percentile(age_ms, (50, 99)), age_ms.max())
        mean, gap, *ages = (f"{number:.1f}" for number in numbers)
        rows.append([f"{side} eye's video", mean, "", gap, *ages])
    return rows


def _overlays(values: dict[str, list[dict[str, str]]]) -> list[list[Any]]:
    reports = values.get("visual_feedback", [])
    rows = []
    for side in SIDES:
        keys = [f"{side} age_{which}_ms" for which in ("p50", "p99", "worst")]
        if not reports or keys[0] not in reports[-1] or float(reports[-1].get(f"{side} drawn", 0)) == 0:
            continue
        drawn = [float(report.get(f"{side} drawn", 0)) for report in reports]
        begun = next(i for i, count in enumerate(drawn) if count > 0)
        rate = (drawn[-1] - drawn[begun]) / (len(drawn) - 1 - begun) if len(drawn) - 1 > begun else float("nan")
        ages = [f"{float(reports[-1][key]):.1f}" for key in keys]
        rows.append([f"{side} eye's overlay", None if np.isnan(rate) else f"{rate:.1f}", "", "", *ages])
    return rows


def _contact(session: Session, found: Findings, side: str) -> list[str]:
    seen, truth = session.topic(f"/contact/{side}"), session.topic(f"/mesa_{side}/truth")
    depth = chart(session, found, side, "depth [mm]", y_include=(0.0,))
    if truth is not None:
        depth.line(truth.t, 1e3 * truth["depth"], "truth", "truth")
    if seen is not None:
        depth.line(seen.t, 1e3 * seen["depth"], "seen", "measured")
    force = chart(session, found, side, "force [N]", y_include=(0.0,))
    if truth is not None:
        force.line(truth.t, _norm(truth, "tip_force"), "truth", "truth")
    by_vision = session.topic(f"/contact_force/{side}/wrench")
    if by_vision is not None:
        force.line(by_vision.t, _norm(by_vision, "wrench.force"), "by vision", "measured")
    return [depth.render(), force.render(), _agreement(seen, truth)]


def _agreement(seen: Topic | None, truth: Topic | None) -> str:
    """Known share, and the error where both are known and the tip is in contact."""
    if seen is None or not len(seen):
        return table(["seen", ""], [["depth", None]])
    depth = np.asarray(seen["depth"], dtype=float)
    rows: list[list[Any]] = [["known", f"{100.0 * np.isfinite(depth).mean():.1f} % of {len(depth)}"]]
    if truth is not None and len(truth):
        nearest = np.clip(np.searchsorted(truth.t, seen.t), 1, max(len(truth) - 1, 1))
        nearest = np.minimum(nearest, len(truth) - 1)
        before = np.maximum(nearest - 1, 0)
        use = np.where(np.abs(truth.t[before] - seen.t) < np.abs(truth.t[nearest] - seen.t), before, nearest)
        true = np.interp(seen.t, truth.t, truth["depth"])
        both = np.isfinite(depth) & (np.abs(truth.t[use] - seen.t) <= APART_S) & (true >= AT_CONTACT_M)
        error_mm = 1e3 * (depth[both] - true[both])
        rows.append(["in contact and known", f"{both.sum()} samples"])
        rms = f"{np.sqrt(np.mean(error_mm**2)):.2f} mm RMS, {error_mm.mean():+.2f} mm mean" if both.any() else None
        rows.append(["error of the depth there", rms])
    return table(["seen", ""], rows)


def _norm(topic: Topic, field: str) -> Array:
    return np.asarray(np.linalg.norm([topic[f"{field}.{axis}"] for axis in "xyz"], axis=0))
