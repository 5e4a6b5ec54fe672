"""Hyper-parameters from the samples. The core has it only where Ceres was there to build with."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from saras._core.model import GpLearning, learn_hyperparameters
else:
    try:
        from saras._core.model import GpLearning, learn_hyperparameters
    except ImportError:

        class _Missing:
            """Names the package at the first use: the rest of saras.model works without it."""

            def __call__(self, *arguments: Any, **named: Any) -> Any:
                raise ImportError(
                    "learn_hyperparameters: saras was built without Ceres; install it (apt-get install libceres-dev) "
                    "and build again"
                )

        GpLearning = learn_hyperparameters = _Missing()

__all__ = ["GpLearning", "learn_hyperparameters"]
