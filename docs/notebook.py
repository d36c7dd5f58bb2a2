"""Make the notebook of the tutorial from its page: `python docs/notebook.py`.

Blocks of Python and commands become cells of code, everything else cells of text. No outputs are
stored, so that the notebook changes only where the page does.
"""

import json
import re
from pathlib import Path

PAGE = Path(__file__).with_name("tutorial.md")
BLOCK = re.compile(r"```(python|sh)\n(.*?)```\n", re.DOTALL)
METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}


def written(page: str) -> str:
    """Return the notebook of a page, as text."""
    cells, text, end = [], "", 0
    for block in BLOCK.finditer(page):
        kind, code = block.groups()
        text += page[end : block.start()]
        end = block.end()
        if kind == "sh" and not code.startswith("contactlaw"):
            text += block[0]  # an installation, which is not for the notebook to do
            continue
        cells += [cell("markdown", text), cell("code", code if kind == "python" else f"!{code}")]
        text = ""
    cells.append(cell("markdown", text + page[end:]))
    for number, one in enumerate(cells):
        one["id"] = f"cell-{number}"
    book = {"cells": cells, "metadata": METADATA, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(book, indent=1, ensure_ascii=False) + "\n"


def cell(kind: str, source: str) -> dict:
    """Return a cell of a notebook."""
    found = {"cell_type": kind, "metadata": {}, "source": source.strip("\n").splitlines(True)}
    return found | ({"execution_count": None, "outputs": []} if kind == "code" else {})


if __name__ == "__main__":
    PAGE.with_suffix(".ipynb").write_text(written(PAGE.read_text("utf-8")), "utf-8")
