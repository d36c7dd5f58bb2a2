"""The list of small faults, which `make mutations` puts into the sources, fits the sources."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
sys.path.append(str(ROOT / "tests/mutations"))
from mutate import edits  # noqa: E402


@pytest.mark.parametrize("edit", edits(), ids=lambda edit: f"{edit.file}: {' '.join(edit.text.split())[:40]}")
def test_an_edit_can_be_made_and_names_a_test(edit):
    assert (ROOT / edit.file).read_text("utf-8").count(edit.text) == 1 and edit.replacement != edit.text
    file, _, name = edit.test.partition("[")[0].partition("::")
    name = name.replace("::", ".").rpartition(".")[2]
    assert not edit.test or f"def {name}(" in (ROOT / file).read_text("utf-8")
