"""Table and solver answer through one interface, and say the same."""

import numpy as np
import polymer
import pytest

import contactlaw as cl
from contactlaw import laws
from contactlaw.answers import tabulated
from contactlaw.answers.backend import OutsideTableError
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import TableLookup, extent
from contactlaw.answers.yields import yield_speeds
from contactlaw.equation.losses import Losses
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_of
from contactlaw.physical.scaling import yield_share

R = 0.9e-3
PAIRS = {
    "the bead yields": ("gamma-alumina", "glass"),
    "the plate yields": ("bearing-steel-52100", "aluminium-6061-t6"),
    "both yield": ("carbon-steel-1020", "carbon-steel-1020"),
}
LOSSES = [f"{channel}_fraction" for channel in Losses._fields]


def backends(pair, law, outside="raise"):
    """Table and solver of one model."""
    pair = pair if isinstance(pair, cl.Pair) else cl.Pair(*pair)
    bodies = SphereOnPlate(pair, law_of(pair, law))
    return TableLookup(bodies, None, outside), Solver(bodies, extent=extent(bodies.law))


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("law", laws.names())
def test_at_the_yield_speed_flow_begins(law, pair):
    thickness = R / np.array([1e-12, 0.01, 0.5, 1.0, 1.5])
    radius = np.full(thickness.size, R)
    tabulated, solver = backends(PAIRS[pair], law)
    impacts = Impacts.on_plates(1.0, radius, thickness)
    found = yield_speeds(tabulated, impacts)
    hit = solver.rebounds(Impacts(found, radius, thickness, found.shape))
    if law == "fem":
        assert hit.overload == pytest.approx(1.0, rel=1e-6)
    else:
        least = yield_share(solver.bodies.pair, solver.bodies.law) * R
        assert hit.peak_compression == pytest.approx(least, rel=1e-8)
    # The bead yields where some compression is left after the rebound: another way to find it.
    if law in ("myc", "thornton") and pair == "the bead yields":
        below, above = (
            solver.rebounds(Impacts(found * by, radius, thickness, found.shape)) for by in (1 - 1e-4, 1 + 1e-4)
        )
        assert (below.plastic_fraction == 0.0).all() and (above.plastic_fraction > 0.0).all()


def test_nothing_yields():
    tabulated, solver = backends(("soda-lime-glass", "soda-lime-glass"), "hertz")
    impacts = Impacts.on_plates(1.0, np.ones(2) * R, R)
    assert (yield_speeds(tabulated, impacts) == np.inf).all()


@pytest.mark.parametrize("law", ["fem", "myc"])
def test_a_solver_with_an_extent_refuses_what_the_table_does(law):
    """The speeds and radii lie on both sides of both limits of the table."""
    refused = []
    for v, h in ((1e-3, 1e-3), (5.0, 2e-5), (3000.0, 1e-2), (3.0, 3e-4), (20.0, 2e-3)):
        impacts = Impacts.on_plates([1.0, v], R, [1e-2, h])
        said = []
        for backend in backends(PAIRS["the bead yields"], law):
            try:
                backend.rebounds(impacts)
                said.append("")
            except OutsideTableError as error:
                said.append(str(error))
        assert said[0] == said[1]
        refused.append(said[0])
    assert any("too thin" in one for one in refused) and any("too fast" in one for one in refused)
    assert "" in refused


@pytest.mark.parametrize("law", ["fem", "myc"])
def test_plates_too_thin_to_say_when_they_yield(law):
    radius, thickness = np.full(2, R), np.array([R, R / 20.0])
    tabulated, _ = backends(PAIRS["the bead yields"], law)
    impacts = Impacts.on_plates(1.0, radius, thickness)
    with pytest.raises(ValueError, match="thickness: got .*; too thin for the table"):
        yield_speeds(tabulated, impacts)


def test_without_a_compiler_no_table_is_built(monkeypatch):
    """It would take minutes, and integrating this impact takes a tenth of a second."""
    monkeypatch.setattr(tabulated, "switched_off", lambda: True)
    monkeypatch.setattr(tabulated, "table_for", None)
    model = cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"))
    hit = model.lookup([0.5, 3.0], 1e-3, 1e-3)
    assert (hit.restitution == model.solve([0.5, 3.0], 1e-3, 1e-3, rtol=1e-10).restitution).all()
    assert 0.0 < model.yield_speed(1e-3, 1e-3) < 0.5
    with pytest.raises(OutsideTableError, match="too fast"):
        model.lookup(1e5, 1e-3, 1e-3)


@pytest.mark.parametrize("law", laws.names())
def test_what_the_sphere_loses_is_the_sum_over_the_channels(law):
    fractions = [name for name in cl.Rebound.__dataclass_fields__ if name.endswith("_fraction")]
    assert fractions == LOSSES
    speed = np.geomspace(0.01, 15.0, 40)
    for pair in (*PAIRS.values(), *(polymer.PAIRS[:2] if law == "fem" else ())):
        tabulated, _ = backends(pair, law, outside="solve")
        for backend, bound in ((tabulated, 1e-5), (Solver(tabulated.bodies), 1e-9)):
            hit = backend.rebounds(Impacts.on_plates(speed, R, R / 0.7))
            lost = sum(getattr(hit, name) for name in LOSSES)
            assert 1.0 - hit.restitution**2 == pytest.approx(lost, abs=bound)
            assert all((getattr(hit, name) >= 0.0).all() for name in LOSSES)


def test_two_beads_build_no_table_of_plates():
    model = cl.ImpactModel(cl.Pair(*PAIRS["the bead yields"]))
    model.lookup_sphere_sphere(5.0, R, R)
    assert "table" not in vars(model._tabulated)
    assert model._beads(None) is model._beads(None)
    assert model._beads(None).bodies.law != model.force_law  # the pair's law depends on the plate
