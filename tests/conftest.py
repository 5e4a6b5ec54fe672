"""Switches shared by all tests: --many N multiplies the random draws (CI and acceptance runs use it)."""

from __future__ import annotations

import os

import hypothesis
import pytest

hypothesis.settings.register_profile("local", deadline=None, max_examples=100, derandomize=True)
hypothesis.settings.load_profile("local")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--many",
        type=int,
        default=int(os.environ.get("SARAS_MANY", "1")),
        help="multiply the number of random draws by this",
    )


def pytest_configure(config: pytest.Config) -> None:
    many = config.getoption("--many")
    if many > 1:
        hypothesis.settings.register_profile("many", deadline=None, max_examples=100 * many)
        hypothesis.settings.load_profile("many")


@pytest.fixture(scope="session")
def many(request: pytest.FixtureRequest) -> int:
    """How many times more random draws than the local default."""
    return int(request.config.getoption("--many"))
