"""The pages of rain and sieve: whole in one file, and in a browser what they should be."""

import re

import numpy as np
import pytest
from browser import WIDE
from demos import runs_of
from unrendered import blank

from dem_demo import cli
from dem_demo.rain import paths

PICTURE = "document.getElementById('rain').toDataURL()"
CONTACT = "document.getElementById('contact').toDataURL()"


@pytest.fixture
def page(page):
    """A page about which the browser has nothing to complain."""
    page.complaints.clear()
    yield page
    assert page.complaints == []


@pytest.fixture(params=["rain", "oblique"])
def folder(request):
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("folder", ["rain", "oblique", "sieve"], indirect=True)
def test_the_page_needs_nothing_else_and_is_small(folder):
    text = (folder / "index.html").read_text()
    assert len(text.encode()) < 5e6
    sources = re.findall(r"(?:src|href|srcset)=['\"]([^'\"]*)", text)
    assert len(sources) >= text.count("<figure") > 0
    assert all(source.startswith("data:") for source in sources)
    assert not any(words in text for words in ("url(", "http:", "https:"))


@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_of_a_sieve_fits_the_screen(sieve, page, width):
    page.open(sieve / "index.html", width)
    assert page.value("innerWidth") == width  # a phone zooms out until all of a page is seen
    assert page.value("document.documentElement.scrollWidth") <= width


@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_fits_the_screen_and_moves(folder, page, width):
    page.open(folder / "index.html", width)
    assert page.value("innerWidth") == width
    assert page.value(WIDE) == []
    assert page.wait_for_change(PICTURE)
    assert page.wait_for_change(CONTACT)
    assert page.value("document.getElementById('play').textContent") == "Pause"
    page.value("document.getElementById('play').click()")
    assert page.value(PICTURE) == page.value(PICTURE)
    page.value("document.getElementById('others').click()")
    for button in range(3):
        page.value(f"document.getElementById('plates').children[{button}].click()")
        assert page.value("document.getElementById('hit').textContent").startswith("The hardest")
    assert page.value(WIDE) == []


def test_nothing_moves_for_those_who_prefer_that(folder, page):
    page.open(folder / "index.html", 390, prefers_reduced_motion="reduce")
    assert page.value("document.getElementById('play').textContent") == "Play"
    assert page.value(PICTURE) == page.value(PICTURE)
    page.value("document.getElementById('play').click()")
    assert page.wait_for_change(PICTURE)


def test_the_animation_goes_where_the_beads_went(folder):
    """The pieces of flight on the page pass through every recorded frame."""
    (run,) = runs_of(folder)
    made = paths.pieces(run)
    seen = 0
    for n, time in enumerate(run.time.tolist()):
        now = made[(made["start"] <= time + 1e-9) & (time + 1e-9 < made["end"])]
        age, flying = time - now["start"], run.status[n, now["bead"]] == 1
        assert flying.sum() == (run.status[n] == 1).sum()
        rise = now["y"] + now["v"] * age - 0.5 * now["fall"] * age**2
        off = abs(np.column_stack((now["x"] + now["u"] * age, rise)) - run.position[n, now["bead"]])[flying]
        assert off.max(initial=0.0) < 1e-4  # [m]; the smallest radius is 5e-4
        seen += off.size
        assert (now["spin"] == run.spin[n, now["bead"], 0])[flying].all()
    assert seen > 1000


def test_a_bead_turns_on_from_piece_to_piece(folder):
    made = paths.pieces(*runs_of(folder))
    one, two = made[:-1], made[1:]
    turned = one["angle"] + one["spin"] * (one["end"] - one["start"])
    np.testing.assert_allclose(two["angle"], np.where(one["bead"] == two["bead"], turned, 0.0), atol=1e-6)


def test_a_rain_that_never_lands(tmp_path, page, monkeypatch, capfd):
    """Without a terminal it is quiet."""

    def laid_out(figure):
        figure.draw_without_rendering()
        return blank(figure)

    monkeypatch.setattr("contactlaw.style.png", laid_out)
    few = "rain --law myc --beads 2 --speed 0.5,0.6 --duration 0.01".split()
    assert cli.main([*few, "--out", str(tmp_path)]) == 0
    said, errors = capfd.readouterr()
    assert "Written to" in said and errors == ""
    assert "No impact on a wall is flagged" in (tmp_path / "summary.txt").read_text()
    page.open(tmp_path / "index.html", 390)
    assert page.value(WIDE) == []
