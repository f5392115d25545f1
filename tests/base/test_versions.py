import platform

import numpy as np

from lidarena.base.versions import library_versions


def test_versions_are_those_that_run() -> None:
    versions = library_versions()
    assert versions["python"] == platform.python_version()
    assert versions["numpy"] == np.__version__


def test_a_library_that_is_not_installed_has_no_version() -> None:
    assert library_versions(["no-such-library"]) == {"python": platform.python_version(), "no-such-library": None}
