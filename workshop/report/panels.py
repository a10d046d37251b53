"""Figures of the report as plotly traces and layouts; the page's script knows the roles' colours."""

from __future__ import annotations

from typing import Any

import numpy as np

from workshop.figure import Classes, Level, Line, Map, Panel, Span, subscripts

DASHES = {"solid": "solid", "dash": "dash", "dot": "dot"}
CIVIDIS = [
    [0.0, "#00224e"],
    [0.2, "#2f406c"],
    [0.4, "#61656f"],
    [0.6, "#918b73"],
    [0.8, "#c6b867"],
    [1.0, "#fee838"],
]


def text(label: str) -> str:
    """Subscripts as HTML."""
    return subscripts(label, "<sub>", "</sub>")


def numbers(values: Any) -> list[float | None]:
    """Five digits: what a screen can show; no value for what is not finite."""
    return [float(f"{v:.5g}") if np.isfinite(v) else None for v in np.asarray(values, dtype=float)]


def panel_data(panel: Panel) -> dict[str, Any]:
    """Traces, layout and levels of one panel, ready for JSON."""
    traces: list[dict[str, Any]] = []
    shapes: list[dict[str, Any]] = []
    for item in panel.items:
        match item:
            case Line():
                traces.append(_line(item))
            case Level():
                traces.append(_level(item, panel))
            case Span():
                shapes.append(_span(item))
                traces.append(_key(item.label, item.colour))
            case Map():
                traces += _map(item)
            case Classes():
                traces += _classes(item)
    drawn = [item for item in panel.items if isinstance(item, Line | Map | Classes)]
    layout = {
        "title": text(panel.title),
        "xaxis": _axis(panel.x_label, panel.x_log, panel.x_range, [item.x for item in drawn]),
        "yaxis": _axis(panel.y_label, panel.y_log, panel.y_range, [item.y for item in drawn]),
        "shapes": shapes,
        "showlegend": panel.legend and any(trace.get("showlegend") for trace in traces),
    }
    return {"traces": traces, "layout": layout}


def _axis(
    label: str, logarithmic: bool, limits: tuple[float, float] | None, values: list[Any]
) -> dict[str, Any]:
    axis: dict[str, Any] = {"title": {"text": text(label)}, "type": "log" if logarithmic else "linear"}
    if logarithmic:
        every = np.concatenate([np.asarray(v, dtype=float).ravel() for v in values])
        low, high = limits or (np.nanmin(every), np.nanmax(every))
        axis |= {"exponentformat": "power", "dtick": max(1, round(float(np.log10(high / low)) / 5.0))}
    if limits:
        axis["range"] = [float(np.log10(v)) if logarithmic else float(v) for v in limits]
    return axis


def _line(item: Line) -> dict[str, Any]:
    trace: dict[str, Any] = {
        "type": "scatter",
        "x": numbers(item.x),
        "y": numbers(item.y),
        "name": text(item.label),
        "showlegend": bool(item.label),
        "role": item.colour,
    }
    if item.markers:
        return trace | {"mode": "markers", "marker": {"size": 8}}
    return trace | {"mode": "lines", "line": {"width": 1.2 * item.width, "dash": DASHES[item.dash]}}


def _level(item: Level, panel: Panel) -> dict[str, Any]:
    """A line between the ends of the panel's lines, so that it is in the legend and under the pointer."""
    ends = [np.asarray(other.x, dtype=float) for other in panel.items if isinstance(other, Line)]
    x = panel.x_range or (min(e.min() for e in ends), max(e.max() for e in ends))
    return _line(Line(x, (item.y, item.y), item.label, item.colour, item.dash, 1.4))


def _span(item: Span) -> dict[str, Any]:
    return {
        "type": "rect",
        "xref": "paper",
        "x0": 0,
        "x1": 1,
        "y0": item.low,
        "y1": item.high,
        "line": {"width": 0},
        "opacity": 0.2,
        "layer": "below",
        "role": item.colour,
    }


def _key(name: str, colour: str) -> dict[str, Any]:
    """A coloured square in the legend, and nothing in the plot."""
    return {
        "type": "scatter",
        "x": [None],
        "y": [None],
        "mode": "markers",
        "marker": {"size": 11, "symbol": "square"},
        "name": text(name),
        "showlegend": True,
        "role": colour,
    }


def _map(item: Map) -> list[dict[str, Any]]:
    grid = [numbers(row) for row in item.z]
    common = {"x": numbers(item.x), "y": numbers(item.y), "z": grid}
    heat = common | {
        "type": "heatmap",
        "zmin": item.low,
        "zmax": item.high,
        "zsmooth": "best",
        "colorscale": "diverging" if item.diverging else CIVIDIS,
        "colorbar": {"title": {"text": text(item.label), "side": "right"}, "thickness": 12, "len": 1.0},
        "hovertemplate": "%{x:.3g}, %{y:.3g}: %{z:.3g}<extra></extra>",
    }
    lines = [
        common
        | {
            "type": "contour",
            "contours": {
                "type": "constraint",
                "operation": "=",
                "value": level,
                "showlabels": True,
                "labelfont": {"size": 10},
            },
            "line": {"width": 1},
            "showlegend": False,
            "hoverinfo": "skip",
            "role": "ink" if item.diverging else "white",
        }
        for level in item.contours
    ]
    return [heat, *lines]


def _classes(item: Classes) -> list[dict[str, Any]]:
    n = len(item.names)
    heat = {
        "type": "heatmap",
        "x": numbers(item.x),
        "y": numbers(item.y),
        "z": [[int(v) for v in row] for row in item.z],
        "text": [[text(item.names[int(v)]) for v in row] for row in item.z],
        "hovertemplate": "%{x:.3g}, %{y:.3g}: %{text}<extra></extra>",
        "zmin": -0.5,
        "zmax": n - 0.5,
        "showscale": False,
        "opacity": 0.8,
        "roles": list(item.colours),
    }
    return [heat, *(_key(name, colour) for name, colour in zip(item.names, item.colours, strict=True))]
