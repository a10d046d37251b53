"""The picture of a fit: forces, the 95 % region of the first two parameters, and a record's residuals."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import RectBivariateSpline

from frictioncontact import style
from frictioncontact.identification.data import Series
from frictioncontact.identification.experiment import Experiment, Parameter
from frictioncontact.identification.fit import Fit
from frictioncontact.identification.judge import motion, spectrum

WIDEST = 3.0  # half-width of the map in coordinates: a factor of 20, or 3 rad
REACHES = (1.5, 3.0, 6.0)  # of a map over its region, had the sum of squares a parabola's shape
FINE = 200  # places a side between which a contour is straight


def picture(experiment: Experiment, result: Fit) -> Figure:
    """Measured and fitted forces, the region; of a record its loop, the residuals and their spectrum."""
    points = 31 if experiment.word == "row" else 11  # a side of the map; a record costs more than rows
    if isinstance(experiment.rows, Series):
        figure, ((left, right), below) = style.subplots(2, 2, size=(10.0, 7.6))
        _draw_loop(left, experiment, result)
        _draw_residuals(*below, experiment, result)
    else:
        figure, (left, right) = style.subplots(1, 2, size=(10.0, 4.2))
        _draw_means(left, experiment, result)
    left.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.2)  # off the data
    if len(result.parameters) == 1:
        _draw_curve(right, experiment, result, points)
    else:
        _draw_region(right, experiment, result, points)
    return figure


def _draw_loop(axes: Axes, experiment: Experiment, result: Fit) -> None:
    """Over the position, or the integral of the velocity."""
    rows = experiment.rows
    path = cumulative_trapezoid(rows.V, rows.time, initial=0.0) if rows.position is None else rows.position
    place = 1e6 * np.interp(experiment.time, rows.time, path)
    axes.plot(place, experiment.force, ".", ms=3, color=style.SOURCE["paper"], label="measured")
    axes.plot(place, result.model, color=style.SOURCE["identified"], lw=1.2, label="fitted")
    axes.set(xlabel="position [µm]", ylabel="friction force [N]", title="Force over position")


def _draw_residuals(over_time: Axes, over_frequency: Axes, experiment: Experiment, result: Fit) -> None:
    over_time.plot(experiment.time, result.residuals, color=style.BLUE, lw=0.8)
    over_time.set(xlabel="time [s]", ylabel="fitted - measured [N]", title="Residuals")
    frequencies, power = spectrum(experiment, result.residuals)
    amplitude = 2.0 * np.sqrt(power[4:]) / len(result.residuals)
    over_frequency.loglog(frequencies[4:], amplitude, color=style.BLUE, lw=0.8)
    over_frequency.axvline(motion(experiment), color=style.ORANGE, ls="--", lw=1.2)
    over_frequency.set(xlabel="frequency [Hz]", ylabel="amplitude [N]", ylim=(1e-3 * amplitude.max(), None))
    over_frequency.set_title("Their spectrum; dashed: the motion")


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
    axes.set(xlabel=label, ylabel="mean friction force [N]", title="Means")
    _ticks(axes, "x", place, place.min() > 0.0 and name != "row")
    axes.set_ylim(min(0.0, 1.1 * measured.min()), 1.12 * max(measured.max(), result.model.max()))


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
    """Sums of squares at rows of the first coordinates; the others follow as the slopes say.

    nan where the FMU refuses, or a coordinate is out of bounds.
    """
    count = coordinates.shape[1]
    held, others = result.slopes[:, :count], result.slopes[:, count:]
    moves = -np.linalg.lstsq(others, held, rcond=None)[0]
    away = coordinates - result.point[:count]
    points = result.point + np.hstack([away, away @ moves.T])
    good = ((points >= experiment.low) & (points <= experiment.high)).all(axis=1)
    squares = np.full(len(points), np.nan)
    squares[good] = [
        np.sum(experiment.misfits(point[None], experiment.target) ** 2)
        + np.sum(point[len(result.parameters) :][experiment.measured] ** 2)
        for point in points[good]
    ]
    return squares


def _axis(p: Parameter, coordinates: np.ndarray) -> tuple[np.ndarray, str]:
    values = p.values(coordinates)
    if p.unit == "rad":
        return np.degrees(values), f"{p.name} [deg]"
    return values, p.name if p.unit == "1" else f"{p.name} [{p.unit}]"


def _draw_curve(axes: Axes, experiment: Experiment, result: Fit, points: int) -> None:
    grid = np.linspace(*_window(result, 0), points)
    values, label = _axis(result.parameters[0], grid)
    axes.plot(values, _misfits(experiment, result, grid[:, None]), color=style.BLUE)
    if np.isfinite(bound := result.region_bound):
        axes.axhline(bound, color=style.ORANGE, ls="--")
    axes.set(xlabel=label, ylabel="sum of squares", title="Below the dashed line: 95 % region")
    _ticks(axes, "x", values, result.parameters[0].logarithmic)


def _draw_region(axes: Axes, experiment: Experiment, result: Fit, points: int) -> None:
    """The joint 95 % region of the first two parameters, on a grid along the axes of their covariance."""
    best, bound, covariance = result.coordinates[:2], result.region_bound, result.covariance[:2, :2]
    is_known = np.isfinite(covariance).all() and np.isfinite(bound)
    size, turn = np.linalg.eigh(covariance if is_known else np.eye(2))
    axis = np.linspace(-1.0, 1.0, points)
    for reach in REACHES:
        radius = np.sqrt((bound - result.squares) / result.variance) if is_known else WIDEST
        half = np.minimum(reach * radius * np.sqrt(np.maximum(size, 0.0)), WIDEST)
        unit = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1)
        misfit = _misfits(experiment, result, (best + unit * half @ turn.T).reshape(-1, 2))
        misfit = np.where(np.isfinite(misfit), misfit, np.nanmax(misfit)).reshape(points, points)
        edge = np.concatenate([misfit[[0, -1]].ravel(), misfit[:, [0, -1]].ravel()])
        if not is_known or edge.min() > bound:
            break
    fine = np.linspace(-1.0, 1.0, FINE)
    smooth = (
        RectBivariateSpline(axis, axis, np.sqrt(np.maximum(misfit - result.squares, 0.0)))(fine, fine) ** 2
    )
    place = best + np.stack(np.meshgrid(fine, fine, indexing="ij"), axis=-1) * half @ turn.T
    (x, x_label), (y, y_label) = (_axis(p, place[..., k]) for k, p in enumerate(result.parameters[:2]))
    level = bound - result.squares if is_known else np.median(smooth)
    axes.contourf(x, y, smooth, levels=[-level, level], colors=[style.LIGHT])
    axes.contour(x, y, smooth, levels=[level], colors=[style.ORANGE], linewidths=2)
    axes.plot(*[_axis(p, best[k : k + 1])[0][0] for k, p in enumerate(result.parameters[:2])], "o")
    title = "95 % region, and the fit" if is_known else "Half of what was searched; no 95 % region"
    axes.set(xlabel=x_label, ylabel=y_label, title=title)
    _ticks(axes, "x", x, result.parameters[0].logarithmic)
    _ticks(axes, "y", y, result.parameters[1].logarithmic)
