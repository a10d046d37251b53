// The four figures and the line of numbers above them.
"use strict";

const TIME_UNITS = [[1, "s"], [1e3, "ms"], [1e6, "µs"], [1e9, "ns"]];
const LENGTH_UNITS = [[1, "m"], [1e3, "mm"], [1e6, "µm"], [1e9, "nm"]];
const ENERGY_UNITS = [[1, "J"], [1e3, "mJ"], [1e6, "µJ"], [1e9, "nJ"]];
const STIFFNESS_UNITS = [[1, "N/m"], [1e-3, "kN/m"], [1e-6, "MN/m"], [1e-9, "GN/m"]];

// The unit in which size is a handy number.
function handy(units, size) {
  const sorted = [...units].sort((a, b) => a[0] - b[0]);
  return sorted.find(([factor]) => size * factor >= 1) ?? sorted[sorted.length - 1];
}

function extent(numbers) {
  const known = [...numbers].filter((number) => !Number.isNaN(number));
  return [Math.min(...known), Math.max(...known)];
}

// Round limits around zero and all values; the limit of friction keeps them still while a slider moves.
function forceRange(force, limit) {
  const [low, high] = extent(force);
  const up = roundUp(1.08 * Math.max(high, low < -0.02 * limit ? 0 : limit, -low / 10));
  return [low < -0.02 * limit ? -roundUp(-1.08 * low) : 0, up];
}

// The circle of the limit in the plane, in 120 parts.
function circle(radius) {
  const angles = Array.from({ length: 121 }, (_, k) => (2 * Math.PI * k) / 120);
  return { x: angles.map((angle) => radius * Math.cos(angle)), y: angles.map((angle) => radius * Math.sin(angle)) };
}

// Spans of time where the surfaces slide backwards.
function backwards({ time, velocity }) {
  const spans = [];
  velocity.forEach((V, k) => {
    if (V < 0 && !(velocity[k - 1] < 0)) spans.push([time[k], time[k]]);
    if (V < 0 || velocity[k - 1] < 0) spans.at(-1)[1] = time[k];
  });
  return spans;
}

const FORCE_TITLE = "Friction force <var>F</var><sub>t</sub> in N";
const LEAST_REDUCTION = 1e-3; // per cent; below, it is the error of two means
const LEAST_TRANSVERSE = 2e-6; // of the limit; below, it is the tolerance of a mean

class Figures {
  // dragged(kind, {x, y}): a person points at a place in a figure.
  constructor(dragged) {
    const host = (name) => document.getElementById(name);
    const linear = { x: {}, y: {} };
    this.force = new Chart(host("force"), linear);
    this.loop = new Chart(host("loop"), linear);
    this.mean = new Chart(host("mean"), { x: { log: true }, y: {} });
    this.map = new RegimeChart(host("map"));
    this.mean.onDrag((at) => dragged("mean", at));
    this.map.onDrag((at) => dragged("map", at));
    this.curve = null;
  }

  showWave(wave, regime, V_1, inPlane) {
    const [timeFactor, timeUnit] = handy(TIME_UNITS, wave.time.at(-1));
    const time = wave.time.map((t) => t * timeFactor);
    const y = forceRange(inPlane ? [...wave.force, ...wave.transverse] : wave.force, regime.limit);
    const meanText = `mean ${readable(wave.mean)} N`;
    this.force.draw({
      x: [0, time.at(-1)],
      y,
      bands: backwards({ time, velocity: wave.velocity }),
      lines: [
        ...(inPlane ? [{ x: time, y: wave.transverse, kind: "transverse" }] : []),
        { x: time, y: wave.force, kind: "force" },
      ],
      rules: [{ y: wave.mean, kind: "mean", text: meanText }],
      summary: `Friction force over two periods, from ${readable(Math.min(...wave.force))} to ${readable(Math.max(...wave.force))} N, ${meanText}`,
    });
    setText("force-x", `Time in ${timeUnit}`);
    document.getElementById("transverse-key").hidden = !inPlane;
    setHtml("force-y", inPlane ? "Friction force in N" : FORCE_TITLE);
    setHtml("loop-title", inPlane ? "Path of the force in the plane" : "Force against displacement");
    setHtml("loop-y", inPlane ? "Transverse friction force <var>F</var><sub>y</sub> in N" : FORCE_TITLE);
    if (inPlane) this.showPath(wave, regime.limit);
    else this.showLoop(wave, V_1, y);
  }

  // The force as a vector over the two periods, and the limit that it has at rest.
  showPath(wave, limit) {
    const [low, high] = extent([...wave.force, ...wave.transverse]);
    const reach = roundUp(1.08 * Math.max(limit, high, -low));
    this.loop.draw({
      isSquare: true,
      y: [-reach, reach],
      lines: [
        { ...circle(limit), kind: "coulomb" },
        { x: wave.force, y: wave.transverse, kind: "force" },
      ],
      points: [{ x: wave.mean, y: wave.transverseMean, kind: "here", title: "mean" }],
      summary: `Path of the force in the plane, its mean ${readable(wave.mean)} N along and ${readable(wave.transverseMean)} N transverse`,
    });
    setHtml("loop-text", '<span class="key here"></span> mean <span class="key coulomb"></span> limit at rest');
    setHtml("loop-x", FORCE_TITLE);
  }

  showLoop(wave, V_1, y) {
    const [low, high] = extent(wave.displacement);
    const [lengthFactor, lengthUnit] = handy(LENGTH_UNITS, Math.max(high, -low));
    const reach = roundUp(1.04 * lengthFactor * Math.max(high, -low));
    const x = wave.displacement.map((x) => x * lengthFactor);
    this.loop.draw({
      x: V_1 > 0 ? [-reach, reach] : [Math.min(0, low * lengthFactor), Math.max(high * lengthFactor, 1e-12)],
      y,
      lines: [{ x, y: wave.force, kind: "force" }],
      rules: [{ y: wave.mean, kind: "mean" }],
      summary: `Friction force against displacement over ${readable((high - low) * lengthFactor)} ${lengthUnit}`,
    });
    setHtml("loop-text", V_1 > 0 ? "The area is the work of the vibration." : "The area is the work.");
    setHtml("loop-x", `${V_1 > 0 ? "Displacement of the vibration" : "Sliding distance"} in ${lengthUnit}`);
  }

  // here: {ratio, V, mean, without, amplitude: "1" or "2", rigid: what a rigid contact would give, or null}; measured:
  // points of the preset, or none.
  showMean(here, measured) {
    const { curve } = this;
    if (!curve) return;
    const [low, high] = extent(curve.y);
    const points = curve.isRatio ? (measured ?? []).map(([x, y, text]) => ({ x, y, kind: "measured", title: text })) : [];
    const own = curve.isRatio ? { x: here.ratio, y: here.mean / here.without } : { x: here.V, y: here.mean };
    const top = roundUp(1.05 * Math.max(curve.isRatio ? 1 : 0, high, ...points.map(({ y }) => y)));
    const bottom = low < -0.02 * top ? -roundUp(-1.05 * low) : 0;
    const isShown = own.x > 0 && Number.isFinite(own.y);
    this.mean.draw({
      x: extent(curve.x),
      y: [bottom, top],
      lines: [
        ...(here.rigid ? [{ x: curve.x, y: curve.x.map(here.rigid.mean), kind: "coulomb" }] : []),
        { x: curve.x, y: curve.y, kind: "force" },
      ],
      points: [...(isShown ? [{ ...own, kind: "here", title: "this scene" }] : []), ...points],
      summary: `Mean friction against the velocity ratio; this scene at ${readable(own.x)} has ${readable(own.y)}`,
    });
    setHtml("mean-y", curve.isRatio ? "Mean friction over that without vibration" : "Friction force in N");
    setHtml("mean-x", curve.isRatio ? `Velocity ratio <var>V</var>/<var>V</var><sub>${here.amplitude}</sub>` : "Sliding velocity <var>V</var> in m/s");
    document.getElementById("mean-key").hidden = !here.rigid;
    setHtml("mean-formula", here.rigid?.formula ?? "");
    document.getElementById("measured-key").hidden = points.length === 0;
  }

  showRegime({ kappa, zeta }, amplitude) {
    const V = `<var>V</var><sub>${amplitude}</sub>`;
    setHtml("map-y", `Velocity ratio <var>ζ</var> = <var>V</var>/${V}`);
    setHtml("map-x", `Stiffness number <var>κ</var> = <var>σ</var>${V}/(2π<var>f F</var><sub>C</sub>)`);
    const isShown = kappa > 0 && Number.isFinite(zeta) && zeta > 0;
    document.getElementById("map-none").hidden = kappa > 0;
    this.map.draw({
      x: MAP.kappa,
      y: MAP.zeta,
      points: isShown ? [{ x: kappa, y: zeta, kind: "here", title: "this scene" }] : [],
      summary: isShown
        ? `Regime map; this scene at kappa ${readable(kappa)}, zeta ${readable(zeta)}`
        : "Regime map; this scene has no place in it",
    });
  }

  showNumbers(wave, regime, without, inPlane) {
    setNumber("mean-force", wave.mean, "N");
    const isRounding = Math.abs(wave.transverseMean) < LEAST_TRANSVERSE * regime.limit;
    setNumber("transverse-mean", isRounding ? 0 : wave.transverseMean, "N");
    document.getElementById("transverse-mean").closest("div").hidden = !inPlane;
    setNumber("without", without, "N");
    const reduction = without > 0 ? 100 * (1 - wave.mean / without) : NaN;
    setNumber("reduction", Math.abs(reduction) < LEAST_REDUCTION ? 0 : reduction, "%");
    setNumber("work", wave.W_f, "J", ENERGY_UNITS);
    setNumber("heat", wave.Q_f, "J", ENERGY_UNITS);
    setNumber("stiffness", regime.sigma, "N/m", STIFFNESS_UNITS);
    setNumber("normal-force", regime.F_n, "N");
    setNumber("kappa", regime.kappa, "");
    setNumber("zeta", regime.zeta, "");
  }
}

const written = new Map(); // what was last put into an element, by its id

function put(id, property, content) {
  if (written.get(id) !== content) document.getElementById(id)[property] = content;
  written.set(id, content);
}

const setText = (id, text) => put(id, "textContent", text);
const setHtml = (id, html) => put(id, "innerHTML", html);

// Shows a number in a handy unit; the value attribute holds it in full, in SI.
function setNumber(id, value, unit, units) {
  const element = document.getElementById(id);
  element.value = String(value);
  const [factor, text] = units && value ? handy(units, Math.abs(value)) : [1, unit];
  setText(id, withUnit(value * factor, Number.isFinite(value) ? text : ""));
}
