"""Used by catkin_python_setup only; `pip install .` reads pyproject.toml."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["saras_ros1", "saras_ros1.nodes"], package_dir={"": "."}))
