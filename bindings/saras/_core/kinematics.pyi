"""
Chains and the SARAS arm
"""

from __future__ import annotations

__all__: list[str] = list()
