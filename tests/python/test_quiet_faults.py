"""One line for what goes wrong without a HOLD."""

from __future__ import annotations

from saras_ros1.quiet_faults import REPEAT_S, LinkFaults, TankFaults


def test_refused_datagrams_are_told_at_once_and_then_summed_up():
    faults = LinkFaults("assistant")
    counts = {"accepted": 5, "sessions": 1, "gaps": 0, "replayed": 0}
    assert faults.update(counts, 0.0) == ""
    assert "3 replayed" in faults.update({**counts, "accepted": 9, "replayed": 3}, 1.0)
    assert faults.update({**counts, "replayed": 5, "gaps": 1}, 2.0) == ""
    text = faults.update({**counts, "replayed": 7, "gaps": 1}, 1.0 + REPEAT_S)
    assert "4 replayed" in text and "1 gaps" in text and "assistant" in text
    assert faults.update({**counts, "replayed": 7, "gaps": 1}, 100.0) == ""


def test_what_was_refused_before_the_first_look_is_told():
    assert "2 malformed" in LinkFaults("assistant").update({"accepted": 1, "malformed": 2}, 0.0)


def test_an_empty_tank_is_told_once_and_so_is_its_end():
    faults = TankFaults("tank_slave")
    assert faults.update(0.0, 0.4) == ""
    assert "motion is withheld" in faults.update(0.99, 0.02)
    assert faults.update(1.0, 0.02) == faults.update(0.9, 0.03) == ""
    assert "has energy again" in faults.update(0.2, 0.2)
    assert faults.update(0.0, 0.4) == ""
