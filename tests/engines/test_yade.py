"""YADE's example beside a loop of one's own and the solver, on the same three impacts."""

import numpy as np
import pytest
import scenes

import contactlaw as cl


def test_the_example_has_the_impacts_of_a_loop_and_of_the_solver(tmp_path):
    """The example prints four digits; tangential CORs in its steps differ from the solver's by 1.6e-3."""
    thickness, cor, integrated, along, integrated_along = scenes.by_yade(tmp_path).T
    model, scene = cl.ImpactModel(cl.Pair("gamma-alumina", "glass")), scenes.YADE
    loop = scenes.by_loop(scene, model)
    hit = model.oblique(5.0, 3.0, 0.9e-3, 1e-3 * thickness, scene.friction, method="solve")
    assert thickness.tolist() == [0.5, 1.0, 3.0]
    assert loop.rows["bead"].tolist() == [1, 2, 3]
    assert integrated == pytest.approx(hit.restitution, abs=6e-5)
    assert integrated_along == pytest.approx(hit.tangential_restitution, abs=6e-5)
    assert cor == pytest.approx(loop.rows["restitution"], abs=3e-4)
    assert along == pytest.approx(loop.v[:, 0] / 3.0, abs=1e-3)
    assert np.abs(along - integrated_along).max() < 2e-3  # steps promise 0.012 mu V, which is 4e-3 here
