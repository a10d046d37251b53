// What the figures show, computed with an Fmu: a wave of two periods, means over the velocity, the regime map.
// values maps the FMU's names to SI numbers and item names; what is not named has the FMU's start.
"use strict";

const SAMPLES = 240; // a period
const PERIODS_SHOWN = 2;

// Amplitude [m/s] of the vibration in the plane: the one along, or the transverse one if there is none.
function swing(values) {
  return values["vibration.V_1"] || values["vibration.V_2"] || 0;
}

// Whether something moves, or is deflected, transverse to the sliding.
function isPlane(values) {
  return Boolean(values.V_y || values["vibration.V_2"] || values.delta_y_0);
}

// The mean force of a rigid contact over its limit, against V over the amplitude: a function and its formula,
// or null if the vibration is not along or transverse alone.
function rigid(values) {
  if (values.V_y || !swing(values)) return null;
  if (!values["vibration.V_2"]) {
    return { mean: (zeta) => (2 / Math.PI) * Math.asin(Math.min(zeta, 1)), formula: "(2/π) arcsin <var>ζ</var>" };
  }
  if (values["vibration.V_1"]) return null;
  return { mean: transverseMean, formula: "(2/π) <var>ζ</var> K(1/(1 + <var>ζ</var>²))/√(1 + <var>ζ</var>²)" };
}

// K(m) is pi/2 over the arithmetic-geometric mean of 1 and sqrt(1 - m).
function transverseMean(zeta) {
  let [a, b] = [Math.hypot(1, zeta), zeta];
  for (let k = 0; k < 8; k++) [a, b] = [(a + b) / 2, Math.sqrt(a * b)];
  return zeta / a;
}

// The two periods that are shown: time [s] from their start, force and transverse force [N], velocity [m/s],
// displacement of the vibration [m], work and heat a period [J], and the settled means [N].
function wave(fmu, values) {
  fmu.start(values);
  const [f, V, V_1] = fmu.read(["vibration.f", "V", "vibration.V_1"]);
  const count = SAMPLES * PERIODS_SHOWN;
  const step = 1 / f / SAMPLES;
  const outputs = ["F_t", "F_y"];
  const sums = ["W_f", "Q_f"];
  const before = fmu.read(sums);
  const columns = Array.from({ length: 5 }, () => new Float64Array(count + 1));
  const [time, force, transverse, velocity, displacement] = columns;
  fmu.choose(outputs);
  for (let k = 0; k <= count; k++) {
    if (k > 0) fmu.step(step);
    const [F, F_y] = fmu.again(outputs.length);
    const phase = (2 * Math.PI * k) / SAMPLES;
    time[k] = k * step;
    force[k] = F;
    transverse[k] = F_y;
    velocity[k] = V + V_1 * Math.cos(phase); // Eq. 24
    displacement[k] = V_1 > 0 ? (V_1 / (2 * Math.PI * f)) * Math.sin(phase) : V * time[k];
  }
  const after = fmu.read(sums);
  const perPeriod = Object.fromEntries(sums.map((name, k) => [name, (after[k] - before[k]) / PERIODS_SHOWN]));
  const [mean, transverseMean] = fmu.read(["F_t_settled", "F_y_settled"]); // with static friction of several periods
  return { time, force, transverse, velocity, displacement, mean, transverseMean, ...perPeriod };
}

// Mean force [N] over a period of the vibration once settled: the friction law.
function meanForce(fmu, values) {
  fmu.start({ ...values, initialState: "Given" });
  return fmu.get("F_t_settled");
}

// The friction [N] of the scene without vibration: with oblique sliding its length in the plane.
function steadyForce(fmu, values) {
  const F_t = meanForce(fmu, withoutVibration(values));
  return values.V_y ? Math.hypot(F_t, fmu.get("F_y_settled")) : F_t;
}

function withoutVibration(values) {
  return { ...values, "vibration.V_1": 0, "vibration.V_2": 0, "vibration.a_d": 0 };
}

// The scene at rest: stiffness [N/m], normal force [N], limit of friction [N], and the two
// numbers of the regime: kappa = sigma V_1 / (2 pi f limit), zeta = V / V_1, with V_2 if V_1 is 0.
function regime(fmu, values) {
  fmu.start(withoutVibration(values));
  const [sigma, F_n, f, F_C, mu, V] = fmu.read(["sigma", "F_n", "vibration.f", "F_C", "friction.mu", "V"]);
  const limit = values["friction.limit"] === "Load" ? mu * F_n : F_C;
  const amplitude = swing(values);
  return { sigma, F_n, limit, kappa: (sigma * amplitude) / (2 * Math.PI * f * limit), zeta: V / amplitude };
}

function between(low, high, count) {
  return Float64Array.from({ length: count }, (_, k) => low * (high / low) ** (k / (count - 1)));
}

// Mean force over that without vibration against V over the amplitude in the plane; without vibration in the
// plane, the force [N] against V [m/s].
function curve(fmu, values) {
  const amplitude = swing(values);
  const x = amplitude > 0 ? between(CURVE_LOW, CURVE_HIGH, 97) : between(1e-6, 10, 97);
  const y = x.map((x) => {
    const scene = { ...values, V: amplitude > 0 ? x * amplitude : x };
    const mean = meanForce(fmu, scene);
    return amplitude > 0 ? mean / steadyForce(fmu, scene) : mean;
  });
  return { x, y, isRatio: amplitude > 0 };
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
  return { ...values, V: zeta * swing(values), [stiffnessName(values)]: kappa * stiffnessOfOne(fmu, values) };
}

// The value of the variable that scales the stiffness, over kappa.
function stiffnessOfOne(fmu, values) {
  const name = stiffnessName(values);
  return (values[name] ?? fmu.variables.get(name).start) / regime(fmu, values).kappa;
}

// Cells of the regime map, row by row from low to high zeta: means over the force without vibration.
function* regimeMap(fmu, values, columns, rows) {
  const kappas = between(...MAP.kappa, columns);
  const zetas = between(...MAP.zeta, rows);
  const [name, one] = [stiffnessName(values), stiffnessOfOne(fmu, values)];
  for (const zeta of zetas) {
    const moved = { ...values, V: zeta * swing(values) };
    const without = steadyForce(fmu, moved);
    for (const kappa of kappas) yield meanForce(fmu, { ...moved, [name]: kappa * one }) / without;
  }
}
