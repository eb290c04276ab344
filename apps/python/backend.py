"""The build backend, here and in a source distribution: that of setuptools, which runs setup.py in this folder."""

import os

from setuptools.build_meta import *  # noqa: F403

os.chdir(os.path.dirname(os.path.abspath(__file__)))
