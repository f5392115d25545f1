"""What pyproject.toml cannot say: the wheel holds a copy of ``configs/`` inside the package."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py


class BuildWithConfigs(build_py):
    """Build the package, then add the configurations, which ``lidarena train NAME`` finds there."""

    def run(self) -> None:
        """Build."""
        super().run()
        if not self.editable_mode:  # a checkout has them beside the package
            target = Path(self.build_lib) / "lidarena" / "configs"
            shutil.rmtree(target, ignore_errors=True)
            shutil.copytree("configs", target)


setup(cmdclass={"build_py": BuildWithConfigs})
