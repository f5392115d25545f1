"""What water and a camera do to the picture: haze, backscatter, vignetting and noise."""

from dataclasses import dataclass

from lidarena.base.keyword_checks import check_range


@dataclass(frozen=True)
class Water:
    """The picture J of the seabed at a range r is seen as V (J exp(-haze r) + glow (1 - exp(-haze r))) + noise.

    Attributes:
        haze: Attenuation of light [1/m].
        backscatter: Grey of the veil that water without end would show, brightest in the middle of the picture.
        vignetting: Share of the light that the corners lose.
        noise: Standard deviation of each pixel's grey.

    Raises:
        ConfigError: A number out of range.
    """

    haze: float = 0.03
    backscatter: float = 90.0
    vignetting: float = 0.3
    noise: float = 1.0

    def __post_init__(self) -> None:
        check_range("haze", self.haze, 0.0, 5.0)
        check_range("backscatter", self.backscatter, 0.0, 255.0)
        check_range("vignetting", self.vignetting, 0.0, 0.95)
        check_range("noise", self.noise, 0.0, 50.0)


CLEAR = Water(haze=0.0, backscatter=0.0, vignetting=0.0, noise=0.0)
"""Air, and a camera without faults."""
