"""
Simulated arm, tissue, hand and network
"""

from __future__ import annotations

__all__: list[str] = list()
