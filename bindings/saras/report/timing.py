"""Rates, losses and latencies of recorded topics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from saras.recording import Session, Topic

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Rate:
    """Periods of one topic at the recorder."""

    topic: str
    count: int
    mean_hz: float
    median_hz: float
    period_p5_ms: float
    period_p99_ms: float
    longest_gap_ms: float
    age_p99_ms: float | None  #: from the header's stamp to the recorder; None without a stamp
    lost: int | None  #: messages missing by sequence number; None when they carry none
    restarts: int  #: times that the sequence number fell back


@dataclass(frozen=True)
class Latency:
    """Time from a node's input to its output."""

    hop: str
    method: str  #: "same stamp" or "latest input"
    p50_ms: float
    p95_ms: float
    p99_ms: float
    t: Floats
    latency_ms: Floats


def rate(topic: Topic, since: float = 0.0) -> Rate | None:
    """Rate of a topic from ``since`` [s] on, by time of reception; None for fewer than three messages."""
    late = topic.t_received >= since
    received = topic.t_received[late]
    if len(received) < 3:
        return None
    period_ms = np.diff(received) * 1e3
    age_ms = (received - topic.t[late]) * 1e3
    lost: int | None = None
    restarts = 0
    if topic.seq is not None:
        step = np.diff(topic.seq[late].astype(np.int64))
        restarts = int((step < 0).sum())
        # A sequence that never moves is a publisher that does not count.
        lost = int((step[step > 1] - 1).sum()) if (step != 0).any() else None
    return Rate(
        topic.name,
        len(received),
        float(1e3 / period_ms.mean()),
        float(1e3 / np.median(period_ms)) if np.median(period_ms) > 0 else float("nan"),
        float(np.percentile(period_ms, 5)),
        float(np.percentile(period_ms, 99)),
        float(period_ms.max()),
        float(np.percentile(age_ms, 99)) if age_ms.any() else None,
        lost,
        restarts,
    )


def latency(session: Session, hop: str, source: str, result: str) -> Latency | None:
    """Time from ``source`` to ``result`` on the recorder's clock.

    Where the result carries its input's stamp on, message is matched to message; else each result is matched to the
    latest input before it, which is what a node that steps on its primary input answered.
    """
    before, after = session.topic(source), session.topic(result)
    if before is None or after is None:
        return None
    order = np.argsort(before.t, kind="stable")
    place = np.clip(np.searchsorted(before.t[order], after.t), 0, len(order) - 1)
    same = np.abs(before.t[order][place] - after.t) < 1e-7
    if same.mean() > 0.9 and np.median(np.diff(before.t)) > 0:
        method = "same stamp"
        t = after.t_received[same]
        latency_ms = (t - before.t_received[order][place][same]) * 1e3
    else:
        method = "latest input"
        index = np.searchsorted(before.t_received, after.t_received, side="right") - 1
        known = index >= 0
        t = after.t_received[known]
        latency_ms = (t - before.t_received[index[known]]) * 1e3
    if len(t) == 0:
        return None
    p50, p95, p99 = (float(np.percentile(latency_ms, q)) for q in (50, 95, 99))
    return Latency(hop, method, p50, p95, p99, t, latency_ms)


def control_topics(session: Session) -> list[tuple[str, str]]:
    """(node, topic) of every node of the graph, by the topic that shows its rate."""
    rows = []
    for side in ("left", "right"):
        rows += [
            (f"touchball_receiver {side}", f"/touchball_{side}/pose"),
            (f"tf_transformer_{side}", f"/tf_transformer_{side}/tracked_pose"),
            (f"transparency {side}", f"/transparency/{side}/desired_twist"),
            (f"tank_master {side}", f"/tank_master/{side}/wrench"),
            (f"tank_slave {side}", f"/tank_slave/{side}/twist"),
            (f"velocity_integrator_{side}", f"/mesa_{side}/set_point"),
            (f"arm_state {side}", f"/mesa_{side}/ee_pose"),
        ]
    if "/collision/distances" in session.topics:  # it need not run
        rows.append(("colliding_regions", "/collision/distances"))
    return rows


def hops(side: str) -> list[tuple[str, str, str]]:
    """(name, input topic, output topic) along both directions of one side."""
    return [
        ("console → frame mapping", f"/touchball_{side}/pose", f"/tf_transformer_{side}/tracked_pose"),
        (
            "frame mapping → transparency",
            f"/tf_transformer_{side}/tracked_pose",
            f"/transparency/{side}/desired_twist",
        ),
        ("transparency → tank_slave", f"/transparency/{side}/desired_twist", f"/tank_slave/{side}/twist"),
        ("tank_slave → set-point", f"/tank_slave/{side}/twist", f"/mesa_{side}/set_point"),
        ("transparency → tank_master", f"/transparency/{side}/desired_wrench", f"/tank_master/{side}/wrench"),
        ("tank_master → touch frame", f"/tank_master/{side}/wrench", f"/touchball_{side}/wrench"),
    ]
