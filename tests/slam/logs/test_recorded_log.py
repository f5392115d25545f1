"""What a user may tell a reader is checked; a log knows whether it has odometry."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lidarena.slam.logs.recorded_log import LogError, LogOptions
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

LOG = record(ring(), way(LAP, stride=0.5))


@pytest.mark.parametrize("wrong", [{"max_range": -1.0}, {"field_of_view": 10.0}, {"range_unit": "km"}])
def test_options_out_of_range_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(LogError, match="allowed"):
        LogOptions(**wrong)


def test_a_log_knows_whether_its_wheels_ever_moved() -> None:
    assert LOG.has_odometry
    assert not replace(LOG, odometry=np.zeros_like(LOG.odometry)).has_odometry
