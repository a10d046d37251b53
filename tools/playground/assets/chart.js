// A figure with axes, drawn as SVG: lines, points, bands and rules, redrawn whole at every frame.
"use strict";

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 52, right: 14, top: 8, bottom: 26 };

function svg(name, attributes, parent) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent?.append(element);
  return element;
}

// Multiples of 1, 2 or 5 times a power of ten: at most count + 2, which leaves at least two.
function linearTicks([low, high], count) {
  const power = 10 ** Math.floor(Math.log10((high - low) / count));
  for (const factor of [1, 2, 5, 10, 20]) {
    const step = factor * power;
    const first = Math.ceil(low / step - 1e-9);
    const ticks = Math.floor(high / step + 1e-9) - first + 1;
    if (ticks <= count + 2) return Array.from({ length: ticks }, (_, k) => (first + k) * step);
  }
}

function logTicks([low, high], count) {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const every = Math.max(1, Math.ceil((last - first) / count));
  return Array.from({ length: Math.floor((last - first) / every) + 1 }, (_, k) => 10 ** (first + k * every));
}

const ticks = ({ log }, range, count) => (log ? logTicks : linearTicks)(range, Math.max(3, Math.round(count)));

// The smallest round number that is not below value.
function roundUp(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return power * ([1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].find((factor) => factor * power >= value * 0.9999) ?? 10);
}

class Chart {
  // host: the element that the drawing fills; axes: {x: {log}, y: {log}}.
  constructor(host, axes) {
    this.host = host;
    this.axes = axes;
    this.svg = svg("svg", { role: "img" }, null);
    host.append(this.svg);
    this.grid = svg("g", { class: "grid" }, this.svg);
    this.clip = svg("clipPath", { id: `clip-${host.id}` }, this.svg);
    this.clipBox = svg("rect", {}, this.clip);
    this.data = svg("g", { "clip-path": `url(#clip-${host.id})` }, this.svg);
    this.marks = svg("g", { class: "marks" }, this.svg);
    this.content = null;
    this.size = null; // measured when it changes: asking at every frame would lay the page out
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  resize() {
    const { clientWidth, clientHeight } = this.host;
    if (clientWidth === 0) return; // not shown yet
    const size = { width: Math.max(clientWidth, 120), height: Math.max(clientHeight, 90) };
    if (size.width === this.size?.width && size.height === this.size?.height) return;
    this.size = size;
    this.svg.setAttribute("viewBox", `0 0 ${size.width} ${size.height}`);
    const inner = { x: MARGIN.left, y: MARGIN.top, ...this.inner() };
    for (const [key, value] of Object.entries(inner)) this.clipBox.setAttribute(key, value);
    if (this.content) this.draw(this.content);
  }

  // Width and height between the axes.
  inner() {
    const { width, height } = this.size;
    return { width: width - MARGIN.left - MARGIN.right, height: height - MARGIN.top - MARGIN.bottom };
  }

  // content: {x: [low, high], y: [low, high], isSquare, bands: [[from, to]], lines: [{x, y, kind}],
  // rules: [{y, kind, text}], points: [{x, y, kind, title}], summary}. isSquare: a unit is as long on both axes,
  // about the origin; x is not given.
  draw(content) {
    this.content = content;
    if (!this.size) return;
    const { width, height } = this.size;
    this.ranges = content.isSquare ? this.square(content.y[1]) : content;
    const x = this.scale(this.axes.x, this.ranges.x, MARGIN.left, width - MARGIN.right);
    const y = this.scale(this.axes.y, this.ranges.y, height - MARGIN.bottom, MARGIN.top);
    this.x = x;
    this.y = y;
    this.drawGrid(this.ranges, width, height);
    this.data.replaceChildren();
    this.marks.replaceChildren();
    for (const [from, to] of content.bands ?? []) {
      const box = { x: x(from), width: x(to) - x(from), y: MARGIN.top, height: this.inner().height };
      svg("rect", { ...box, class: "band" }, this.data);
    }
    for (const rule of content.rules ?? []) this.drawRule(rule, width);
    for (const { x: xs, y: ys, kind } of content.lines ?? []) {
      svg("path", { d: this.path(xs, ys), class: `line ${kind}` }, this.data);
    }
    for (const point of content.points ?? []) this.drawPoint(point);
    this.svg.setAttribute("aria-label", content.summary ?? "");
  }

  // Ranges about the origin that contain reach in every direction.
  square(reach) {
    const { width, height } = this.inner();
    const unit = reach / Math.min(width, height);
    return { x: [-unit * width, unit * width], y: [-unit * height, unit * height] };
  }

  scale({ log }, [low, high], from, to) {
    const of = log ? Math.log10 : (value) => value;
    const factor = (to - from) / (of(high) - of(low));
    const scale = (value) => from + (of(value) - of(low)) * factor;
    scale.back = (pixel) => (log ? 10 ** ((pixel - from) / factor + of(low)) : (pixel - from) / factor + low);
    return scale;
  }

  drawGrid({ x: xRange, y: yRange }, width, height) {
    const key = JSON.stringify([xRange, yRange, width, height]);
    if (key === this.gridKey) return;
    this.gridKey = key;
    this.grid.replaceChildren();
    const bottom = height - MARGIN.bottom;
    for (const tick of ticks(this.axes.x, xRange, width / 75)) {
      const at = this.x(tick);
      svg("line", { x1: at, x2: at, y1: MARGIN.top, y2: bottom }, this.grid);
      this.label(tick, this.axes.x.log, { x: at, y: bottom + 16, "text-anchor": "middle" });
    }
    for (const tick of ticks(this.axes.y, yRange, height / 48)) {
      const at = this.y(tick);
      const zero = !this.axes.y.log && Math.abs(tick) < 1e-12 * yRange[1];
      svg("line", { x1: MARGIN.left, x2: width - MARGIN.right, y1: at, y2: at, class: zero ? "zero" : "" }, this.grid);
      this.label(tick, this.axes.y.log, { x: MARGIN.left - 7, y: at + 4, "text-anchor": "end" });
    }
  }

  label(value, log, attributes) {
    const text = svg("text", attributes, this.grid);
    const exponent = Math.round(Math.log10(Math.abs(value)));
    if (log && exponent !== 0 && exponent !== 1) {
      text.textContent = "10";
      const raised = svg("tspan", { dy: "-0.45em", "font-size": "75%" }, text);
      raised.textContent = String(exponent).replace("-", "−");
    } else {
      text.textContent = String(Number(value.toPrecision(6))).replace("-", "−");
    }
  }

  drawRule({ y, kind, text }, width) {
    const at = this.y(y);
    svg("line", { x1: MARGIN.left, x2: width - MARGIN.right, y1: at, y2: at, class: `rule ${kind}` }, this.data);
    if (!text) return;
    const label = { x: width - MARGIN.right - 6, y: y < 0 ? at + 15 : at - 6, "text-anchor": "end", class: `rule-text ${kind}` };
    svg("text", label, this.marks).textContent = text;
  }

  // A point beyond the axes is drawn at their edge.
  drawPoint({ x, y, kind, title }) {
    const inside = (value, [low, high]) => Math.min(Math.max(value, low), high);
    const at = { cx: this.x(inside(x, this.ranges.x)), cy: this.y(inside(y, this.ranges.y)) };
    const circle = svg("circle", { ...at, r: kind === "here" ? 6 : 4.5, class: `point ${kind}` }, this.marks);
    if (title) svg("title", {}, circle).textContent = title;
  }

  path(xs, ys) {
    const parts = Array.from(xs, (x, k) => {
      if (!Number.isFinite(ys[k])) return "";
      return `${Number.isFinite(ys[k - 1]) ? "L" : "M"}${this.x(x).toFixed(1)} ${this.y(ys[k]).toFixed(1)}`;
    });
    return parts.join("");
  }

  // Calls moved({x, y}) with the values under a pointer that is held down.
  onDrag(moved) {
    const tell = (event) => {
      if (!this.content) return; // nothing is drawn yet
      const box = this.svg.getBoundingClientRect();
      moved({ x: this.x.back(event.clientX - box.left), y: this.y.back(event.clientY - box.top) });
    };
    this.svg.classList.add("draggable");
    this.svg.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      this.svg.setPointerCapture(event.pointerId);
      tell(event);
    });
    this.svg.addEventListener("pointermove", (event) => {
      if (this.svg.hasPointerCapture(event.pointerId)) tell(event);
    });
  }
}
