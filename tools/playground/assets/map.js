// The regime map: colours on a canvas below the axes, and lines of equal friction over it.
"use strict";

// Stops of two colour scales of even lightness steps: from no friction left to all of it, and from none to a
// friction that drives, with the whole force, in the direction of the sliding.
const RESISTS = ["#0b2c46", "#10496a", "#1f6a86", "#3b8b97", "#66aaa1", "#98c6ac", "#cbdfbf", "#f4f3dc"].map(channels);
const DRIVES = ["#2b1a3f", "#6d2a5f", "#b0466a", "#ea7f6b"].map(channels);
const LEVEL_LINES = [0, 0.1, 0.25, 0.5, 0.75, 0.9];

function channels(text) {
  return [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));
}

function colourOf(value) {
  const stops = value < 0 ? DRIVES : RESISTS;
  const place = Math.min(Math.abs(value), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(place), stops.length - 2);
  return stops[k].map((low, channel) => low + (place - k) * (stops[k + 1][channel] - low));
}

class RegimeChart extends Chart {
  constructor(host) {
    super(host, { x: { log: true }, y: { log: true } });
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("aria-hidden", "true");
    host.prepend(this.canvas);
    this.contours = []; // paths in fractions of the map
  }

  // map: {columns, rows, cells}, or null where there is none.
  setMap(map) {
    this.canvas.hidden = !map;
    document.getElementById("drives-key").hidden = !map?.cells.some((value) => value < -0.005);
    this.contours = map ? LEVEL_LINES.map((level) => contour(map, level)) : [];
    if (map) this.paint(map);
    if (this.content) this.draw(this.content);
  }

  paint({ columns, rows, cells }) {
    this.canvas.width = columns;
    this.canvas.height = rows;
    const context = this.canvas.getContext("2d");
    const image = context.createImageData(columns, rows);
    for (let row = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++) {
        const at = 4 * ((rows - 1 - row) * columns + column);
        image.data.set([...colourOf(cells[row * columns + column]), 255], at);
      }
    }
    context.putImageData(image, 0, 0);
  }

  // With canvas and contours between the axes.
  draw(content) {
    super.draw(content);
    if (!this.size) return;
    const { width, height } = this.inner();
    const box = { left: MARGIN.left, top: MARGIN.top, width, height };
    for (const [side, pixels] of Object.entries(box)) this.canvas.style[side] = `${pixels}px`;
    const transform = `translate(${MARGIN.left} ${MARGIN.top + height}) scale(${width} ${-height})`;
    for (const d of this.contours) svg("path", { d, transform, class: "contour" }, this.data);
  }
}

// Marching squares: the line where the cells pass level as a path, in fractions of the map's width and height.
function contour({ columns, rows, cells }, level) {
  const segments = [];
  const value = (column, row) => cells[row * columns + column] - level;
  for (let row = 0; row + 1 < rows; row++) {
    for (let column = 0; column + 1 < columns; column++) {
      const corners = [[column, row], [column + 1, row], [column + 1, row + 1], [column, row + 1]];
      const crossings = [];
      corners.forEach((from, k) => {
        const to = corners[(k + 1) % 4];
        const a = value(...from);
        const b = value(...to);
        if (a < 0 === b < 0) return;
        const part = a / (a - b);
        const [x, y] = from.map((start, axis) => start + part * (to[axis] - start));
        crossings.push(`${(x / (columns - 1)).toFixed(5)} ${(y / (rows - 1)).toFixed(5)}`);
      });
      for (let k = 0; k + 1 < crossings.length; k += 2) segments.push(`M${crossings[k]}L${crossings[k + 1]}`);
    }
  }
  return segments.join("");
}
