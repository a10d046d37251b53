// What the figures show, computed with an Fmu: a wave of two periods, means over the velocity, the regime map.
// values maps the FMU's names to SI numbers and item names; what is not named has the FMU's start.
"use strict";

const SAMPLES = 240; // a period
const PERIODS_SHOWN = 2;
const SETTLING_PERIODS = 1e4; // in one step, where the FMU can't start settled
const SETTLING_TIME = 1e9; // s, without vibration

function start(fmu, values) {
  fmu.start(values);
  if (fmu.has("initialState")) return;
  const [V_1, a_d, f] = fmu.read(["vibration.V_1", "vibration.a_d", "vibration.f"]);
  fmu.step(V_1 > 0 || a_d > 0 ? SETTLING_PERIODS / f : SETTLING_TIME);
}

// The two periods that are shown: time [s] from their start, force [N], velocity [m/s], displacement of the
// vibration [m], and numbers of the whole: mean [N], work and heat a period [J].
function wave(fmu, values) {
  start(fmu, values);
  const [f, V, V_1] = fmu.read(["vibration.f", "V", "vibration.V_1"]);
  const count = SAMPLES * PERIODS_SHOWN;
  const step = 1 / f / SAMPLES;
  const outputs = ["F_t", "F_t_mean"];
  const sums = ["W_f", "Q_f"].filter((name) => fmu.has(name));
  const before = fmu.read(sums);
  const time = new Float64Array(count + 1);
  const force = new Float64Array(count + 1);
  const velocity = new Float64Array(count + 1);
  const displacement = new Float64Array(count + 1);
  let sum = 0;
  fmu.choose(outputs);
  for (let k = 0; k <= count; k++) {
    if (k > 0) fmu.step(step);
    const [F, mean] = fmu.again(outputs.length);
    if (k > 0) sum += mean;
    const phase = (2 * Math.PI * k) / SAMPLES;
    time[k] = k * step;
    force[k] = F;
    velocity[k] = V + V_1 * Math.cos(phase); // Eq. 24
    displacement[k] = V_1 > 0 ? (V_1 / (2 * Math.PI * f)) * Math.sin(phase) : V * time[k];
  }
  const after = fmu.read(sums);
  const perPeriod = Object.fromEntries(sums.map((name, k) => [name, (after[k] - before[k]) / PERIODS_SHOWN]));
  return { time, force, velocity, displacement, mean: sum / count, ...perPeriod };
}

// Mean force [N] over a period of the vibration.
function meanForce(fmu, values) {
  start(fmu, values);
  fmu.step(1 / fmu.get("vibration.f"));
  return fmu.get("F_t_mean");
}

function withoutVibration(values) {
  return { ...values, "vibration.V_1": 0, "vibration.a_d": 0 };
}

// The scene at rest: stiffness [N/m], normal force [N], contact area [m2], limit of friction [N], and the two
// numbers of the regime: kappa = sigma V_1 / (2 pi f limit), zeta = V / V_1.
function regime(fmu, values) {
  fmu.start(withoutVibration(values));
  const [sigma, A_r, f, F_C, V] = fmu.read(["sigma", "A_r", "vibration.f", "F_C", "V"]);
  const F_n = fmu.has("F_n") ? fmu.get("F_n") : NaN;
  const limit = values["friction.limit"] === "Load" ? fmu.get("friction.mu") * F_n : F_C;
  const V_1 = values["vibration.V_1"] ?? 0;
  return { sigma, A_r, F_n, limit, kappa: (sigma * V_1) / (2 * Math.PI * f * limit), zeta: V / V_1 };
}

function between(low, high, count) {
  return Float64Array.from({ length: count }, (_, k) => low * (high / low) ** (k / (count - 1)));
}

// Mean force over that without vibration against V / V_1; without vibration along the sliding, the force [N]
// against V [m/s].
function curve(fmu, values, count = 97) {
  const V_1 = values["vibration.V_1"] ?? 0;
  const x = V_1 > 0 ? between(CURVE_LOW, CURVE_HIGH, count) : between(1e-6, 10, count);
  const y = x.map((x) => {
    const scene = { ...values, V: V_1 > 0 ? x * V_1 : x };
    const mean = meanForce(fmu, scene);
    return V_1 > 0 ? mean / meanForce(fmu, withoutVibration(scene)) : mean;
  });
  return { x, y, isRatio: V_1 > 0 };
}

const CURVE_LOW = 1e-4;
const CURVE_HIGH = 10;
const MAP = { kappa: [1e-2, 1e7], zeta: [1e-4, 10] };

// The name of the variable that scales the stiffness of the scene.
function stiffnessName(values) {
  return values["contact.model"] === "Constant" ? "contact.sigma" : "contact.stiffnessScale";
}

// The scene moved to another point of the map: its V and its stiffness changed, all else as it is.
function sceneAt(fmu, values, kappa, zeta) {
  const name = stiffnessName(values);
  const own = values[name] ?? fmu.variables.get(name).start;
  const here = regime(fmu, values).kappa;
  return { ...values, V: zeta * values["vibration.V_1"], [name]: (own * kappa) / here };
}

// Rows of the regime map, from low to high zeta: each a Float64Array of means over the force without vibration.
function* regimeMap(fmu, values, columns, rows) {
  const kappas = between(...MAP.kappa, columns);
  const zetas = between(...MAP.zeta, rows);
  const here = regime(fmu, values).kappa;
  const name = stiffnessName(values);
  const own = values[name] ?? fmu.variables.get(name).start;
  for (const zeta of zetas) {
    const moved = { ...values, V: zeta * values["vibration.V_1"] };
    const without = meanForce(fmu, withoutVibration(moved));
    yield kappas.map((kappa) => meanForce(fmu, { ...moved, [name]: (own * kappa) / here }) / without);
  }
}
