"""Pairs with a rate of strain: each impact is that of the pair that is as strong as at its rate."""

import dataclasses

import kinds
import pytest
from lasting import long

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.equation import force
from contactlaw.physical import rate
from contactlaw.table import Settings, file

R = 1e-3
PAIR = kinds.RATED["rate of the sphere"]
MODEL = kinds.model("rate of the sphere")
PLAIN = dataclasses.replace(kinds.COPPER, rate=None)


@pytest.mark.parametrize("other", [None, "glass", long(kinds.STEEL)])
def test_beads(other):
    """The rate goes with the reduced radius."""
    v, r, o = 3.0, R, 3.0 * R
    beads = cl.Pair(kinds.COPPER, other or kinds.COPPER)
    pair = rate.strengthened(beads, float(rate.factors(beads, v, r * o / (r + o))))
    alone = cl.ImpactModel(pair).lookup_sphere_sphere(v, r, o, pair.plate)
    hit = MODEL.lookup_sphere_sphere(v, r, o, other)
    assert hit.restitution == pytest.approx(alone.restitution, abs=1e-4)
    assert hit.contact_time == pytest.approx(alone.contact_time, rel=2e-3)
    e = pytest.approx(hit.restitution, abs=1e-4)
    assert MODEL.sphere_sphere_curve(r, o, other)(v) == e
    assert cl.restitution_sphere_sphere(kinds.COPPER, other or kinds.COPPER, v, r, o) == e


def test_tables_of_the_user(tmp_path, capsys):
    short = Settings(largest_overload=5.0)
    at = 0.01, R, 2e-3
    own = cl.ImpactModel(PAIR, table=short)
    assert own.restitution(*at) == pytest.approx(MODEL.restitution(*at), abs=2e-4)
    with pytest.raises(ValueError, match="overload chi = .* is above 5: the impact is too fast"):
        own.restitution(1.0, R, 2e-3)
    path = tmp_path / "pair.h5"
    file.write(own.table, path)
    assert cl.ImpactModel(PAIR, table=path).restitution(*at) == own.restitution(*at)
    quicker = cl.Pair(dataclasses.replace(kinds.COPPER, rate=(0.03, 1.0)), "glass")
    for pair, words in (
        (kinds.RATED["rate of the plate"], "it belongs to law 'fem.*', the model needs one of"),
        (quicker, rf"data {own.table.law.key} and .* differ in their rates"),
    ):
        with pytest.raises(ValueError, match=words):
            cl.ImpactModel(pair, table=own.table)
    assert main(["table", "info", str(path)]) == 0
    assert "strengths up to 1.332 times: " in " ".join(capsys.readouterr().out.split())


def test_a_damaged_table_is_refused():
    """Of laws of several strengths, too, kernels follow addresses: this is the check before they do."""
    laws = MODEL.table.law.at_any_strength
    force.check_strengths(laws)
    for entry, value in ((1 + force.BEGINS, 1e9), (1 + force.SIZE, 1e9), (0, -1e9)):
        damaged = laws.copy()
        damaged[entry] = value
        with pytest.raises(ValueError, match="its law|no law of any strength"):
            force.check_strengths(damaged)


@pytest.mark.parametrize("law", ["myc", "jackson_green", "fem(500,0,0.4,0.3,0.2)"])
def test_other_laws_know_no_rate(law):
    with_rate, without = (cl.ImpactModel(one, law) for one in (PAIR, cl.Pair(PLAIN, "glass")))
    speed = [1e-3, 0.1, 1.0]
    assert (with_rate.solve(speed, R, 3e-3).restitution == without.solve(speed, R, 3e-3).restitution).all()


def test_a_rate0_that_no_impact_reaches_is_no_rate():
    slow = cl.ImpactModel(cl.Pair(dataclasses.replace(kinds.COPPER, rate=(0.05, 6e5)), "glass"))
    plain = cl.ImpactModel(cl.Pair(PLAIN, "glass"))
    assert slow.restitution(3.0, R, 5 * R) == plain.restitution(3.0, R, 5 * R)
