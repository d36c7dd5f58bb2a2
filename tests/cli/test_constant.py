"""`contactlaw constant`: the COR of an engine that takes one number, or a table over speed."""

import re

import numpy as np
import pytest

PAIR = "constant --sphere gamma-alumina --plate glass --law myc --radius 0.9mm"
WALLS = f"{PAIR} --thickness 0.5mm,inf"
CONSTANT = f"{WALLS} --speed 1:60:30log"
FIELDS = "restitution", "spread", "energy_error", "rebound_error", "mean", "mean_energy_error"


def test_a_constant_has_its_errors_beside_it(model, answer):
    question, names, units, thin, thick, _, flag, *meaning = answer(CONSTANT).out.splitlines()
    assert re.split(r"  +", names) == ["thickness", "impacts", "COR", "energy error", "height error", "flags"]
    assert units.split() == ["[mm]", "[-]", "[-]", "[%]", "[%]"]
    wanted = [model.constant(np.geomspace(1, 60, 30), 0.9e-3, h) for h in (0.5e-3, np.inf)]
    height = f"{100 * wanted[0].rebound_error:.3g}"
    assert thin.split() == ["0.5", "30", f"{wanted[0].restitution:.4f}", "0.00", height, "a"]
    assert thick.split()[0] == "inf"
    assert flag.startswith("a: FAST_IMPACT, 4 of 60: ")
    text = " ".join(meaning)
    assert "height error: for 95 % of beads the rebound height is wrong by less than this." in text
    ends = " to ".join(f"{100 * e:.2f}" for e in sorted(best.mean_energy_error for best in wanted))
    assert f"With the plain mean of the CORs the energy error would be {ends} %." in text
    for row, best, thickness in zip(answer(f"{CONSTANT} --csv").rows, wanted, ("0.0005", "inf"), strict=True):
        assert (row["thickness_m"], row["impacts"], row["flags"]) == (thickness, "30", "FAST_IMPACT")
        printed = [float(row[name]) for name in FIELDS]
        assert printed == pytest.approx([getattr(best, name) for name in FIELDS], rel=1e-12, abs=1e-13)


def test_a_constant_from_a_table_of_ones_own(folder, model, answer):
    (folder / "impacts.csv").write_text("Speed [cm/s];weight\n50;3\n800;2\n")
    rows = answer(f"{WALLS} impacts.csv --csv").rows
    for row, thickness in zip(rows, (0.5e-3, np.inf), strict=True):  # every impact happens on both
        best = model.constant([0.5, 8.0], 0.9e-3, thickness, weights=[3, 2])
        assert float(row["restitution"]) == pytest.approx(best.restitution, rel=1e-12)


def test_a_table_over_speed(model, answer):
    line = f"{PAIR} --thickness 1mm --table --error 1e-4 --speed 216km/h,0.1m/s,7m/s"
    printed = answer(line)
    question, head, *rows = printed.out.splitlines()
    assert question == "# gamma-alumina on glass, law myc, radius 0.9 mm, thickness 1 mm, error 0.0001"
    assert head == "speed_m/s,restitution"
    values = np.array([row.split(",") for row in rows], dtype=float)
    wanted = model.speed_table(0.9e-3, 1e-3, 1e-4, fastest=60.0)
    assert values.T.tolist() == [wanted.speed.tolist(), wanted.restitution.tolist()]
    (count,) = wanted.flags.values()
    assert f"warning: FAST_IMPACT, {count} of {len(rows)} rows: faster than" in printed.err
    default = answer(f"{PAIR} --thickness 1mm --table --speed 0.1,10").out.splitlines()
    assert len(default) == 2 + len(model.speed_table(0.9e-3, 1e-3).speed)
