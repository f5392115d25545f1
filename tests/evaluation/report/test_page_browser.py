"""The page in a browser: no errors, sorting sorts, the player plays; skipped where there is no Chromium."""

import shutil
from collections.abc import Iterator
from typing import Any

import pytest

from lidarena.evaluation.report.page import write_page
from lidarena.evaluation.report.sources import content_of_folder
from tests.evaluation.report.folders import results

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
if CHROMIUM is None:
    pytest.skip("needs Chromium, which .ci/run installs on Debian", allow_module_level=True)
sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright, which the lock file installs")
MEAN = "return [...document.querySelectorAll('table.results')[0].tBodies[0].rows].map(r => r.cells[0].textContent)"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """The report, loaded; at the end nothing must have gone wrong or been asked of the network."""
    file = write_page(tmp_path_factory.mktemp("report") / "report.html", content_of_folder(results()))
    trouble: list[str] = []
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page()
        page.on("console", lambda message: trouble.append(message.text))
        page.on("pageerror", lambda error: trouble.append(str(error)))
        page.on("request", lambda request: trouble.append(request.url) if _is_remote(request.url) else None)
        page.goto(file.as_uri())
        page.wait_for_function("window.lidarenaPlayer && window.lidarenaPlayer.ready", timeout=60_000)
        yield page
        browser.close()
    assert trouble == []


def _is_remote(url: str) -> bool:
    return not url.startswith(("file:", "data:", "blob:"))


def order(page: Any) -> list[str]:
    found: list[str] = page.evaluate(f"() => {{ {MEAN} }}")
    return found


def test_sorting_sorts(page: Any) -> None:
    heading = page.locator("table.results").first.locator("thead th")
    assert order(page) == ["driver", "crasher"]
    heading.nth(0).click()
    assert order(page) == ["crasher", "driver"] and heading.nth(0).get_attribute("aria-sort") == "ascending"
    heading.nth(0).click()
    assert order(page) == ["driver", "crasher"] and heading.nth(0).get_attribute("aria-sort") == "descending"
    explored = page.locator("table.results").first.locator("thead th", has_text="Explored")
    explored.click()
    assert order(page) == ["driver", "crasher"]  # the better end first
    explored.click()
    assert order(page) == ["crasher", "driver"]


def test_the_player_plays_and_ends(page: Any) -> None:
    page.select_option("#speed", "10")
    page.click("#play")
    page.wait_for_function("window.lidarenaPlayer.time > 0.5", timeout=20_000)
    page.wait_for_function("!window.lidarenaPlayer.playing", timeout=60_000)
    assert page.evaluate("lidarenaPlayer.time === lidarenaPlayer.end && lidarenaPlayer.end > 5")
    assert page.inner_text("#play") == "Play"


def test_scrubbing_shows_that_instant(page: Any) -> None:
    def picture() -> str:
        data: str = page.evaluate("document.querySelector('#player canvas').toDataURL()")
        return data

    def scrub(to: int) -> str:
        page.evaluate(f"() => {{ const t = document.getElementById('time'); t.value = {to}; "
                      "t.dispatchEvent(new Event('input')); }")  # fmt: skip
        return picture()

    begin, middle = scrub(0), scrub(500)
    assert begin != middle and scrub(1000) not in (begin, middle)
    assert scrub(500) == middle and scrub(0) == begin  # the map goes back as well
    page.uncheck("#layer-map")
    assert picture() != begin
    page.check("#layer-map")
    assert picture() == begin


def test_two_policies_and_another_environment(page: Any) -> None:
    policies = page.locator("select.policy")
    assert (policies.nth(0).input_value(), policies.nth(1).input_value()) == ("driver", "crasher")
    page.select_option("#env", "Other corridor")
    assert page.evaluate("lidarenaPlayer.time") == 0
    policies.nth(1).select_option("driver")
    left, right = (page.locator("#player canvas").nth(k).evaluate("c => c.toDataURL()") for k in (0, 1))
    assert left == right
    policies.nth(1).select_option("crasher")


def test_it_goes_on_drawing_while_it_plays(page: Any) -> None:
    page.evaluate("lidarenaPlayer.time = 0")
    page.select_option("#speed", "1")
    page.click("#play")
    page.wait_for_function("lidarenaPlayer.time > 0")
    drawn = page.evaluate("lidarenaPlayer.drawn")
    page.wait_for_function(f"lidarenaPlayer.drawn > {drawn} + 5")
    page.click("#play")
