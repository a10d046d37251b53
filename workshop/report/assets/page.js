"use strict";
const panels = JSON.parse(document.getElementById("panels").textContent);
const palettes = {
  light: {
    ink: "#222222", grey: "#767676", blue: "#0072b2", orange: "#d55e00", green: "#009e73", pink: "#cc79a7",
    sky: "#56b4e9", amber: "#e69f00", white: "#ffffff", line: "#dfe3e6", text: "#1d2126", middle: "#f7f7f7",
  },
  dark: {
    ink: "#eceff1", grey: "#9aa3ab", blue: "#3fa0de", orange: "#f07f2e", green: "#25c08f", pink: "#e09ac2",
    sky: "#8fd0f5", amber: "#f2b93b", white: "#ffffff", line: "#343a40", text: "#d8dcdf", middle: "#2a2f34",
  },
};
const root = document.documentElement;
const wantsDark = window.matchMedia("(prefers-color-scheme: dark)");

function coloured(trace, palette) {
  const copy = structuredClone(trace);
  const colour = palette[trace.role];
  if (copy.type === "scatter") {
    if (copy.mode === "markers") copy.marker.color = colour;
    else copy.line.color = colour;
  } else if (copy.type === "contour") {
    copy.line.color = colour;
    copy.contours.labelfont.color = colour;
  } else if (copy.roles) {
    const n = copy.roles.length;
    copy.colorscale = copy.roles.flatMap((role, k) => [[k / n, palette[role]], [(k + 1) / n, palette[role]]]);
  } else if (copy.colorscale === "diverging") {
    copy.colorscale = [[0, "#2166ac"], [0.25, "#67a9cf"], [0.5, palette.middle], [0.75, "#ef8a62"], [1, "#b2182b"]];
  }
  return copy;
}

function axis(given, palette) {
  return {
    ...given, tickangle: 0, gridcolor: palette.line, linecolor: palette.grey, zerolinecolor: palette.line, ticks: "outside",
    tickcolor: palette.grey, automargin: "height+width", title: { ...given.title, standoff: 8 },
  };
}

// Plotly sets a horizontal legend in columns as wide as its longest entry; the plot keeps its height above it.
function legendRows(traces, width) {
  const names = traces.filter((trace) => trace.showlegend).map((trace) => trace.name.replace(/<[^>]*>/g, ""));
  if (!names.length) return 0;
  const column = 52 + 6.4 * Math.max(...names.map((name) => name.length));
  return Math.ceil(names.length / Math.max(1, Math.floor((width - 62) / column)));
}

function draw(box) {
  const { traces, layout } = panels[box.dataset.panel];
  const palette = palettes[root.dataset.theme];
  const shapes = layout.shapes.map((shape) => ({ ...shape, fillcolor: palette[shape.role] }));
  const narrow = box.clientWidth < 420;
  const rows = layout.showlegend ? legendRows(traces, box.clientWidth) : 0;
  const plot = narrow ? 210 : 250, bottom = 52 + 20 * rows;
  box.style.height = `${plot + bottom + 8}px`;
  Plotly.react(box, traces.map((trace) => coloured(trace, palette)), {
    xaxis: axis(layout.xaxis, palette), yaxis: axis(layout.yaxis, palette), shapes, showlegend: layout.showlegend,
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    font: { color: palette.text, size: narrow ? 11 : 12, family: "system-ui, DejaVu Sans, sans-serif" },
    margin: { l: 50, r: 12, t: 8, b: bottom }, hovermode: "closest",
    legend: { orientation: "h", y: -48 / plot, yanchor: "top", x: 0, font: { size: narrow ? 10.5 : 11.5 } },
  }, { responsive: true, displaylogo: false, displayModeBar: false });
  box.dataset.drawn = root.dataset.theme;
}

const boxes = [...document.querySelectorAll(".plot")];
const seen = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    entry.target.dataset.visible = entry.isIntersecting ? "yes" : "";
    if (entry.isIntersecting && entry.target.dataset.drawn !== root.dataset.theme) draw(entry.target);
  }
}, { rootMargin: "600px" });

function choose(theme) {
  root.dataset.theme = theme;
  boxes.filter((box) => box.dataset.visible).forEach(draw);
}

choose(wantsDark.matches ? "dark" : "light");
wantsDark.addEventListener("change", (event) => choose(event.matches ? "dark" : "light"));
document.getElementById("theme").addEventListener("click", () => {
  choose(root.dataset.theme === "dark" ? "light" : "dark");
});
window.addEventListener("beforeprint", () => boxes.forEach(draw));
boxes.forEach((box) => seen.observe(box));
