"""Real maps beside the checkout, which tests use where they are present."""

from pathlib import Path

import pytest

DATA = Path(__file__).parents[3] / "shared" / "data"

needs_data = pytest.mark.skipif(not (DATA / "maps").is_dir(), reason=f"the recorded maps are not at {DATA}")
