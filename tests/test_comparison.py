"""Measured CORs beside the model: chi-squared, its probability, and what is not known."""

import numpy as np
import pytest
from command_line import refused
from rebounds import RADIUS, THICKNESS
from scipy import stats

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.comparison import _by_chance

STEEL = cl.Material("my steel", 200e9, 0.29, 7800.0, 1.2e9, kind="metal", uncertainty={"yield_strength": 0.1})
PAIR = cl.Pair(STEEL, "soda-lime-glass")
SPEED = np.geomspace(0.5, 8.0, 9)
HEAD = """# title = "steel on glass"
# thickness_error = "2%"
# plate = "soda-lime-glass"
# [sphere]
# name = "my steel"
# E = "200 GPa"
# nu = 0.29
# rho = 7800.0
# yield = "1200 MPa"
# kind = "metal"
# uncertainty = {yield_strength = 0.1}
"""


def data(cor, error):
    return {"speed": SPEED, "radius": RADIUS, "thickness": THICKNESS, "restitution": cor, "restitution_error": error}


def test_the_probability_is_that_of_chi_squared():
    for count in (1, 3, 20, 200):
        for square in (0.3 * count, count, 2.0 * count):
            exact = stats.chi2.sf(square, count)
            assert _by_chance(square, count) == pytest.approx(exact, abs=8e-3), (count, square)


def test_data_that_scatter_as_stated_agree_by_chance_as_often_as_stated():
    """The model's own rebounds, with bead of a wrong strength, the law's error, and noise."""
    random, error, shares = np.random.default_rng(1), 0.01, []
    exact = cl.ImpactModel(PAIR).solve(SPEED, RADIUS, THICKNESS).restitution
    band = cl.compare(PAIR, data(exact, error)).band
    for _ in range(60):
        off = random.standard_normal() * band.causes["yield strength of the bead"]
        off = off + error * random.standard_normal(SPEED.size)
        shares.append(cl.compare(PAIR, data(exact + off, error)).probability)
    # chi-squared counts the law's error too, which these data do not have
    assert 0.45 < np.mean(shares) < 0.75 and np.mean(np.less(shares, 0.05)) < 0.1
    wrong = cl.compare(PAIR, data(exact - 0.1 * np.linspace(-1.0, 1.0, SPEED.size), error))
    assert wrong.probability < 1e-6


def test_an_error_that_all_rebounds_share_is_no_scatter():
    """With a strength 2 standard errors off, chi-squared is 2^2 or less, and not that of 9 rebounds."""
    stronger = cl.Material("s", 200e9, 0.29, 7800.0, 1.2e9 * np.exp(0.2), kind="metal")
    moved = cl.ImpactModel(cl.Pair(stronger, "soda-lime-glass")).solve(SPEED, RADIUS, THICKNESS).restitution
    found = cl.compare(PAIR, data(moved, 3e-3))
    assert 2.0 < found.chi_squared < 4.6  # the strength is not quite linear
    alone = sum(((moved - found.restitution) / 3e-3) ** 2)
    assert alone > 20.0 * found.chi_squared


def test_what_is_not_known_is_named():
    found = cl.compare(cl.Pair("stainless-steel-304", "glass"), data(0.5 * np.ones(9), 0.01))
    assert found.unknown == ("yield strength of the bead",) and np.isfinite(found.chi_squared)
    with pytest.raises(cl.ArgumentError, match="restitution_error: has to be given"):
        cl.compare(PAIR, {**data(0.5, 0.1), "restitution_error": None})


def test_the_command_reads_conditions_and_draws(tmp_path, capsys):
    cor = cl.ImpactModel(PAIR).solve(SPEED, RADIUS, THICKNESS).restitution
    rows = [f"{v},{1e3 * RADIUS},{1e3 * THICKNESS},{e},0.01" for v, e in zip(SPEED, cor, strict=True)]
    path = tmp_path / "mine.csv"
    path.write_text(HEAD + "\n".join(["speed_m/s,radius_mm,thickness_mm,COR,COR_error", *rows]))
    assert main(["compare", str(path)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "steel on glass" in said and "my steel on soda-lime-glass, law fem" in said
    assert "agrees within the known errors" in said and "Nearest to the data is law fem" in said
    assert main(["compare", str(path), "--plot", str(tmp_path / "one.svg")]) == 0
    assert "chi-squared" in (tmp_path / "one.svg").read_text()
    capsys.readouterr()
    text = path.read_text()
    for old, new, words in (
        ('# plate = "soda-lime-glass"\n', "", "--plate: has to be given"),
        ("thickness_error", "thicknes_error", "did you mean thickness_error"),
        ("# kind", "# knd", "did you mean kind"),
        ("# title", "# by me\n# title", "are no TOML"),
        (",COR_error", ",remark", "restitution_error: has to be given"),
    ):
        path.write_text(text.replace(old, new))
        refused(["compare", str(path)], words, capsys=capsys)
