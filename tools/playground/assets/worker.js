// Curves and maps, computed beside the page so that it never stalls. A newer scene ends the work on an older one.
"use strict";

const LEVELS = [[19, 11], [37, 21], [73, 41]]; // columns and rows of the map, from coarse to fine
const SLICE = 8; // ms of work between two looks at the mail
const PATIENCE = 1000; // ms: a map that takes longer does not stay that of the scene before, and is not refined

let fmu = null;
let latest = null;
let working = false;
let done = 0; // the scene whose curve was sent last
let mapKey = null; // of the map that is finished

const mail = () => new Promise((resolve) => setTimeout(resolve));

onmessage = async ({ data }) => {
  if (data.module) fmu = new Fmu(data.module, data.description);
  else latest = data;
  if (fmu && latest && !working) {
    working = true;
    while (latest) await work();
    working = false;
    postMessage({ id: done, done: true });
  }
};

// What the map depends on: all but where in it the scene is.
function keyOf(values) {
  const rest = { ...values };
  delete rest.V;
  delete rest[stiffnessName(values)];
  return JSON.stringify(rest);
}

function sendCurve({ id, values }) {
  done = id;
  postMessage({ id, curve: curve(fmu, values) });
}

async function work() {
  const { id, values } = latest;
  latest = null;
  try {
    sendCurve({ id, values });
    const key = keyOf(values);
    if (key === mapKey) return;
    mapKey = null;
    if (!(swing(values) > 0)) {
      postMessage({ id, map: null });
      mapKey = key;
      return;
    }
    let isOld = true; // the map that the page shows
    for (const [columns, rows] of LEVELS) {
      const cells = new Float64Array(columns * rows);
      let count = 0;
      const start = performance.now();
      let begin = start;
      for (const cell of regimeMap(fmu, values, columns, rows)) {
        cells[count++] = cell;
        if (performance.now() - begin > SLICE) {
          if (isOld && begin - start > PATIENCE) {
            postMessage({ id, map: null });
            isOld = false;
          }
          await mail();
          if (latest && keyOf(latest.values) !== key) return;
          if (latest) {
            sendCurve(latest);
            latest = null;
          }
          begin = performance.now();
        }
      }
      postMessage({ id, map: { columns, rows, cells } });
      isOld = false;
      if (performance.now() - start > PATIENCE) break;
    }
    mapKey = key;
  } catch (error) {
    if (!(error instanceof Refusal)) throw error; // the page shows what the FMU refuses
  }
}
