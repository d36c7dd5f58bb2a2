"""`dem-demo rain` with other materials, and impacts that the model refuses; what stops a scene: `test_session.py`."""

import pytest
from demos import names
from lasting import long

import contactlaw as cl
from dem_demo import cli


def test_an_impact_outside_the_table_is_integrated_or_stops_the_run(tmp_path, nothing_drawn, capsys):
    """Beads of carbon steel hit each other harder than the law's table reaches."""
    hard = ["rain", "--sphere", "carbon-steel-1020", "--law", "myc", "--duration", "0.3"]
    hard += ["--beads", "40", "--out", str(tmp_path / "out")]
    assert cli.main([*hard, "--outside", "raise"]) == 1
    (refusal,) = capsys.readouterr().err.splitlines()
    for part in ("bead of carbon-steel-1020", "on the plate of 0.5 mm", " m/s: ", "chi = "):
        assert part in refusal
    assert names(tmp_path) == set()
    assert cli.main([*hard, "--outside", "clamp"]) == 0
    assert "outside the table, the value is that of its border" in capsys.readouterr().out
    assert cli.main(hard) == 0
    run = cl.read_record(tmp_path / "out/rain.h5")
    assert not (run.impacts["flags"] & cl.Validity.CLAMPED).any()


# An elastic one, a metal with a rate of strain, and a rubber; metals and polymers without a rate
# are in the long tests.
KINDS = "glass", "aluminium-2024-t351", "epdm"


@pytest.mark.parametrize("sphere", [one if one in KINDS else long(one) for one in cl.materials()])
def test_every_bead_of_the_catalogue_runs_with_the_law_fem(sphere, request, tmp_path, capsys):
    """The beads fall on glass at up to 15 m/s; figures are drawn of bodies that do not yield."""
    request.getfixturevalue("empty_pictures" if sphere == "glass" else "nothing_drawn")
    few = ["rain", "--law", "fem", "--beads", "15", "--duration", "0.2", "--plates", "1e-3,3e-3"]
    few += ["--sphere", sphere, "--out", str(tmp_path / "out")]
    assert cli.main(few) == 0, capsys.readouterr().err
    record = cl.read_record(tmp_path / "out" / "rain.h5")
    assert record.made["law"] == "fem"
    assert record.rows.size > 0
