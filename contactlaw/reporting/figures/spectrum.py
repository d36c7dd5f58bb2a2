"""Which power the beads feed into each wall, at which frequencies.

Above: the mean power that bending waves carry away, in each third octave. Below: the one-sided
spectrum of the force on the wall, which is flat up to about half of the reciprocal contact time.
"""

from cycler import cycler
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.run import Run

_COLOURS = style.BLUE, style.ORANGE, style.GREEN, style.VERMILION, style.SKY, style.PURPLE
_SPAN = 1e4  # largest power and force over the least that are drawn


def draw(run: Run) -> Figure:
    """Draw power and force over frequency, a line for each wall."""
    spectrum, _ = run.waves
    assert spectrum is not None
    bands = slice(1, -1)  # without all below the first and all above the last
    frequency = 1e-3 * spectrum.frequency[bands]
    title = "Power into the walls, by frequency"
    figure = style.figure(style.COLUMN, 8.0 + 0.25 * len(run.walls), title, run.subject)
    quantities = {"power in a third octave [W]": spectrum.power, "spectrum of the force [N²/Hz]": spectrum.force}
    for axes, (label, values) in zip(figure.subplots(2, 1), quantities.items(), strict=True):
        axes.set_prop_cycle(cycler(linestyle=["-", "--"]) * cycler(color=_COLOURS))
        axes.loglog(frequency, values[:, bands].T, label=[wall.name for wall in run.walls])
        most = values[:, bands].max()
        axes.set(xlabel="frequency [kHz]", ylabel=label, ylim=(most / _SPAN, 2.0 * most))
        style.decades(axes.xaxis, (1.0,))
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center")
    return figure
