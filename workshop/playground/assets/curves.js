// What the figures show, computed with an Fmu: a wave of two periods, means over the velocity, the regime map.
// values maps the FMU's names to SI numbers and item names; what is not named has the FMU's start.
"use strict";

const SAMPLES = 240; // a period
const PERIODS_SHOWN = 2;

// The two periods that are shown: time [s] from their start, force [N], velocity [m/s], displacement of the
// vibration [m], and numbers of the whole: mean [N], work and heat a period [J].
function wave(fmu, values) {
  fmu.start(values);
  const [f, V, V_1] = fmu.read(["vibration.f", "V", "vibration.V_1"]);
  const count = SAMPLES * PERIODS_SHOWN;
  const step = 1 / f / SAMPLES;
  const outputs = ["F_t", "F_t_mean"];
  const sums = ["W_f", "Q_f"];
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

// Mean force [N] over a period of the vibration once settled: the friction law.
function meanForce(fmu, values) {
  fmu.start({ ...values, initialState: "Given" });
  return fmu.get("F_t_settled");
}

function withoutVibration(values) {
  return { ...values, "vibration.V_1": 0, "vibration.a_d": 0 };
}

// The scene at rest: stiffness [N/m], normal force [N], limit of friction [N], and the two
// numbers of the regime: kappa = sigma V_1 / (2 pi f limit), zeta = V / V_1.
function regime(fmu, values) {
  fmu.start(withoutVibration(values));
  const [sigma, F_n, f, F_C, mu, V] = fmu.read(["sigma", "F_n", "vibration.f", "F_C", "friction.mu", "V"]);
  const limit = values["friction.limit"] === "Load" ? mu * F_n : F_C;
  const V_1 = values["vibration.V_1"] ?? 0;
  return { sigma, F_n, limit, kappa: (sigma * V_1) / (2 * Math.PI * f * limit), zeta: V / V_1 };
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
