"""Random impacts come to an end when they are integrated: a part of the campaign."""

from contactlaw.answers.backend import UnsolvedError
from validation.hostile import solver


def test_random_impacts_come_to_an_end():
    assert list(solver.faults(40_000, seed=2)) == []


def test_the_campaign_names_what_does_not(monkeypatch):
    solved, raised = solver.solved, []

    def stumbling(law, lam, y, rtol):
        if not raised:
            raised.append(UnsolvedError(7, "lambda = 1", "more than 200000 steps"))
            raise raised[0]
        return solved(law, lam, y, rtol)

    monkeypatch.setattr(solver, "solved", stumbling)
    (fault,) = solver.faults(1000, seed=2)
    assert "more than 200000 steps" in fault and "Material(" in fault
