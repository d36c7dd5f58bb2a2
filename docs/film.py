"""Film the page of a rain: `PYTHONPATH=tests/shared python docs/film.py rain/index.html docs/rain.gif`.

The film shows the time with most rebounding beads, in slow motion, with the page's scale of colours.
"""

import io
import sys
import tempfile
from base64 import b64decode
from pathlib import Path

from browser import browser
from PIL import Image

FRAMES, RATE, SLOWER = 100, 20, 20  # frames, and those per second [1/s], so many times slower than the rain
WIDTH, COLOURS = 720, 96  # pixels; of all frames together
LENGTH = FRAMES / (RATE * SLOWER)
# The rain alone, without what a reader would click on; gives its place on the page.
STAGE = """(() => {
  playing = byId("others").checked = false;
  document.querySelectorAll(".controls, h2").forEach((part) => part.style.display = "none");
  document.documentElement.style.overflow = "hidden";
  document.querySelector(".legend").lastChild.textContent = " COR of a bead's last impact on a plate; grey: none yet";
  const box = byId("rain").closest("section").getBoundingClientRect();
  return {x: box.x - 6, y: box.y + scrollY - 6, width: box.width + 12, height: box.height + 12};
})()"""
BUSIEST = """(() => {
  const up = (p, t) => p.start <= t && t < p.end && p.restitution >= 0 && height(p, p.v, t - p.start) > 0;
  const bouncing = (t) => pieces.filter((p) => up(p, t) && left < p.x && p.x < right).length;
  const times = [...Array(200).keys()].map((n) => (n / 200) * data.duration);
  return times.reduce((best, t) => (bouncing(t) > bouncing(best) ? t : best));
})()"""


def main(page: Path, gif: Path) -> None:
    """Write the film of a page."""
    frames = []
    with tempfile.TemporaryDirectory() as profile, browser(Path(profile)) as tab:
        tab.open(page, WIDTH, prefers_reduced_motion="reduce")
        tab.value(STAGE)  # the canvas takes its new size, and then its place
        clip = {**tab.value(STAGE), "scale": 0.5}  # the browser draws two points for each pixel
        begin = max(0.0, tab.value(BUSIEST) - 0.5 * LENGTH)
        for n in range(FRAMES):
            tab.value(f"(now = {begin + n * LENGTH / FRAMES}, redraws[0](), 0)")
            shot = tab.call("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)
            frames.append(Image.open(io.BytesIO(b64decode(shot["data"]))).convert("RGB"))
    palette = frames[FRAMES // 2].quantize(COLOURS)  # one palette, or it flickers
    first, *others = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    first.save(gif, "GIF", save_all=True, append_images=others, duration=round(1e3 / RATE), loop=0)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
