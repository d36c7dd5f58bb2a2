"""The demo without rendering, which takes most of the time of a short run.

All figures are drawn and all files written, but pictures are empty. Tests of pictures and pages
render them; this is for tests of what happens around them.
"""

import io
import sys

RUN = "import sys; from dem_demo import cli; sys.exit(cli.main())"  # takes what follows `dem-demo`
COMMAND = [sys.executable, "-c", f"from contactlaw import style; style.png = lambda figure: b''; {RUN}"]
UNDRAWN = [  # leaves the record alone
    sys.executable,
    "-c",
    f"from dem_demo.kit import session; session.make = lambda *_: None; {RUN}",
]


def blank(figure):
    """Make a picture of the size of a figure, for a page that a browser shows."""
    from PIL import Image

    made = io.BytesIO()
    Image.new("1", tuple(map(int, figure.get_size_inches() * figure.dpi))).save(made, "PNG")
    return made.getvalue()
