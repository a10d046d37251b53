"""The picture of a fit: measured and fitted forces, and how sharply the data fix the first two parameters."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter

from frictioncontact import style
from frictioncontact.identification.data import Series
from frictioncontact.identification.experiment import Experiment, Parameter
from frictioncontact.identification.fit import Fit

WIDEST = 3.0  # half-width of the map in coordinates: a factor of 20, or 3 rad


def picture(experiment: Experiment, result: Fit) -> Figure:
    """Measured and fitted forces, and the sum of squares around the fit."""
    points = 41 if experiment.word == "row" else 11  # a side of the map; a record costs more than rows
    figure, (left, right) = style.subplots(1, 2, size=(10.0, 4.2))
    if isinstance(experiment.rows, Series):
        _draw_record(left, experiment, result)
    else:
        _draw_means(left, experiment, result)
    if len(result.parameters) == 1:
        _draw_curve(right, experiment, result, points)
    else:
        _draw_map(right, experiment, result, points)
    return figure


def _draw_record(axes: Axes, experiment: Experiment, result: Fit) -> None:
    axes.plot(experiment.time, experiment.force, color=style.SOURCE["paper"], lw=1.2, label="measured")
    axes.plot(experiment.time, result.model, color=style.SOURCE["identified"], lw=1.2, label="fitted")
    axes.set(xlabel="time [s]", ylabel="friction force [N]", title="Measured and fitted force")
    axes.legend(loc="lower right")


def _draw_means(axes: Axes, experiment: Experiment, result: Fit) -> None:
    """Against V, or another column where V is one, or the row."""
    rows, measured = experiment.rows, experiment.force
    name = next((each for each in ("V", *rows.names) if np.ptp(rows.column(each)) > 0.0), "row")
    place = experiment.time if name == "row" else rows.column(name)
    error = 1.0 / experiment.weight if experiment.known else np.full(len(measured), result.deviation)
    error = np.where(np.isfinite(error), error, 0.0)
    axes.errorbar(place, measured, error, fmt="o", color=style.SOURCE["paper"], capsize=3, label="measured")
    axes.plot(place, result.model, "_", ms=16, mew=2.5, color=style.SOURCE["identified"], label="fitted")
    unit = "1" if name == "row" else experiment.fmu.variables[name].unit
    label = name if unit == "1" else f"{name} [{unit}]"
    axes.set(xlabel=label, ylabel="mean friction force [N]", title="Measured and fitted means")
    _ticks(axes, "x", place, place.min() > 0.0 and name != "row")
    axes.set_ylim(min(0.0, 1.1 * measured.min()), 1.12 * max(measured.max(), result.model.max()))
    axes.legend(loc="best")


def _ticks(axes: Axes, which: str, values: np.ndarray, logarithmic: bool) -> None:
    """A logarithmic axis where the values span a decade; a few ticks that are short to read."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    if logarithmic and np.max(values) > 10.0 * np.min(values):
        (axes.set_xscale if which == "x" else axes.set_yscale)("log")
        axis.set_minor_formatter(NullFormatter())
        axis.set_major_locator(LogLocator(numticks=6))
    else:
        axis.set_major_locator(MaxNLocator(5))
    axis.set_major_formatter(EngFormatter(sep="") if np.max(values) >= 1e4 else StrMethodFormatter("{x:g}"))


def _window(result: Fit, k: int) -> tuple[float, float]:
    width = 1.6 * result.half_widths[k]
    width = min(max(width, 1e-3), WIDEST) if np.isfinite(width) else WIDEST
    p, x = result.parameters[k], result.coordinates[k]
    return max(x - width, p.to_coordinate(p.low)), min(x + width, p.to_coordinate(p.high))


def _misfits(experiment: Experiment, result: Fit, coordinates: np.ndarray) -> np.ndarray:
    """Sums of squares at rows of the first coordinates, the rest as fitted; nan where the FMU refuses."""
    points = np.repeat(result.point[None, :], len(coordinates), axis=0)
    points[:, : coordinates.shape[1]] = coordinates
    away = experiment.misfits(points, experiment.target)
    nuisances = result.squares - np.sum((result.residuals * experiment.weight) ** 2)
    return np.sum(away**2, axis=1) + nuisances


def _axis(p: Parameter, coordinates: np.ndarray) -> tuple[np.ndarray, str]:
    values = np.array([p.to_value(x) for x in coordinates])
    if p.unit == "rad":
        return np.degrees(values), f"{p.name} [deg]"
    return values, p.name if p.unit == "1" else f"{p.name} [{p.unit}]"


def _draw_curve(axes: Axes, experiment: Experiment, result: Fit, points: int) -> None:
    grid = np.linspace(*_window(result, 0), points)
    values, label = _axis(result.parameters[0], grid)
    axes.plot(values, _misfits(experiment, result, grid[:, None]), color=style.BLUE)
    if np.isfinite(bound := result.region_bound):
        axes.axhline(bound, color=style.ORANGE, ls="--", label="95 % region: below")
        axes.legend()
    axes.set(xlabel=label, ylabel="sum of squares", title="How sharply the data fix it")
    _ticks(axes, "x", values, result.parameters[0].logarithmic)


def _draw_map(axes: Axes, experiment: Experiment, result: Fit, points: int) -> None:
    """Others than the first two parameters stay at their fitted values."""
    across, up = (np.linspace(*_window(result, k), points) for k in (0, 1))
    places = np.stack(np.meshgrid(across, up), axis=-1).reshape(-1, 2)
    misfit = _misfits(experiment, result, places).reshape(points, points)
    (x, x_label), (y, y_label) = (
        _axis(p, grid) for p, grid in zip(result.parameters, (across, up), strict=False)
    )
    least = max(result.squares, 1e-9)
    filled = axes.contourf(x, y, np.log10(np.maximum(misfit, least)), levels=14, cmap="Blues_r", alpha=0.85)
    axes.figure.colorbar(filled, ax=axes, label="log10 of the sum of squares")
    bound = result.region_bound
    if np.isfinite(bound) and np.nanmax(misfit) > bound:
        axes.contour(x, y, misfit, levels=[bound], colors=[style.ORANGE], linewidths=2)
        axes.plot([], [], color=style.ORANGE, lw=2, label="edge of the 95 % region")
    best = [_axis(p, result.coordinates[k : k + 1])[0][0] for k, p in enumerate(result.parameters[:2])]
    axes.plot(*best, "o", color=style.ORANGE, mec="white", ms=8, label="fitted")
    axes.set(xlabel=x_label, ylabel=y_label, title="How sharply the data fix them")
    axes.grid(visible=False)
    _ticks(axes, "x", x, result.parameters[0].logarithmic)
    _ticks(axes, "y", y, result.parameters[1].logarithmic)
    axes.legend(loc="upper right", frameon=True, framealpha=0.9)
