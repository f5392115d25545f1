import matplotlib
import numpy as np
import pytest

from lidarena.envs.window import Window

matplotlib.use("agg")


def picture(grey: int) -> np.ndarray:
    return np.full((40, 60, 3), grey, np.uint8)


@pytest.fixture(autouse=True)
def nothing_stays_open():
    from matplotlib import pyplot

    before = pyplot.get_fignums()
    yield
    assert pyplot.get_fignums() == before


def test_two_windows_show_their_own_pictures() -> None:
    from matplotlib import pyplot

    before, one, other = pyplot.get_fignums(), Window(), Window()
    one.show(picture(10))
    other.show(picture(200))
    one.show(picture(20))
    figures = [pyplot.figure(number) for number in pyplot.get_fignums() if number not in before]
    assert [int(figure.axes[0].images[0].get_array()[0, 0, 0]) for figure in figures] == [20, 200]
    one.close()
    assert len(pyplot.get_fignums()) == len(before) + 1
    other.close()


def test_a_window_can_be_closed_twice_and_opened_again() -> None:
    window = Window()
    window.close()
    window.show(picture(1))
    window.close()
    window.close()
    window.show(picture(2))
    window.close()
