// The page: one scene, its controls and its figures. Values that equal the FMU's own start are left out of it.
"use strict";

const PAUSE = 120; // ms without a change, after which the address follows
const json = (id) => JSON.parse(document.getElementById(id).textContent);
const description = json("description");
const presets = json("presets");

function element(name, properties, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

// The members of each group, in the order in which the groups appear.
const grouped = (members) => Object.entries(Object.groupBy(members, ({ group }) => group));

class Page {
  constructor(module) {
    this.fmu = new Fmu(module, description);
    this.values = {};
    this.preset = null;
    this.touched = null; // the variable that a person last set
    this.accepted = null; // the last scene that the FMU took: values and preset
    this.wrong = ""; // what the address says that is no part of a scene
    this.frame = 0;
    this.copyKind = "fmpy";
    this.asked = { id: 0, values: {} };
    this.figures = new Figures((kind, at) => this.drag(kind, at));
    this.controls = new Map();
    this.makePresets();
    this.restore(); // the first picture, before anything that is not needed for it
    requestAnimationFrame(() => setTimeout(() => this.complete(module)));
  }

  complete(module) {
    this.makeControls();
    this.makeCopies();
    this.show();
    this.startWorker(module);
    addEventListener("hashchange", () => this.restore());
    document.querySelectorAll("#numbers, .figures").forEach(reachable);
    document.body.classList.add("ready");
  }

  startWorker(module) {
    const source = ["core-script", "worker-script"].map((id) => document.getElementById(id).textContent);
    this.worker = new Worker(URL.createObjectURL(new Blob(source, { type: "text/javascript" })));
    this.worker.postMessage({ module, description });
    this.worker.onmessage = ({ data }) => this.receive(data);
    this.worker.postMessage(this.asked);
  }

  // Asks the worker for the curve and the map of a scene.
  ask(values) {
    this.asked = { id: this.asked.id + 1, values };
    document.body.dataset.worker = "busy";
    this.worker?.postMessage(this.asked);
  }

  receive({ id, curve: newCurve, map, done }) {
    if (newCurve && id === this.asked.id) {
      this.figures.curve = newCurve;
      if (this.state) this.figures.showMean(this.state.here, this.preset?.measured);
    }
    if (map !== undefined) this.figures.map.setMap(map);
    if (done && id === this.asked.id) document.body.dataset.worker = "done";
  }

  valueOf(name) {
    const variable = this.fmu.variables.get(name);
    return this.values[name] ?? variable?.start;
  }

  makeControls() {
    for (const [group, specs] of grouped(json("controls-json"))) {
      const fieldset = element("fieldset", {}, element("legend", { textContent: group }));
      for (const spec of specs) {
        const variable = this.fmu.variables.get(spec.name);
        const control = new Control(spec, variable, (name, value) => this.change({ [name]: value }, name));
        this.controls.set(spec.name, control);
        fieldset.append(control.root);
      }
      document.getElementById("controls").append(fieldset);
    }
  }

  makePresets() {
    const select = document.getElementById("preset");
    for (const [label, members] of grouped(presets)) {
      select.append(element("optgroup", { label }, ...members.map(({ title, id }) => new Option(title, id))));
    }
    select.addEventListener("change", () => this.choose(presets.find(({ id }) => id === select.value)));
  }

  choose(preset) {
    this.preset = preset;
    this.touched = null;
    this.wrong = "";
    this.load(preset.values);
  }

  load(values) {
    this.values = {};
    for (const [name, value] of Object.entries(values)) this.keep(name, value);
    if (this.pictured) this.refresh();
    else this.show();
  }

  keep(name, value) {
    if (value === this.fmu.variables.get(name)?.start) delete this.values[name];
    else this.values[name] = value;
  }

  // A person touches a variable, by which these values change.
  change(values, touched) {
    for (const [name, value] of Object.entries(values)) this.keep(name, value);
    this.touched = touched;
    this.wrong = "";
    this.refresh();
  }

  drag(kind, { x, y }) {
    const amplitude = swing(this.full());
    const inside = (value, [low, high]) => Math.min(Math.max(value, low), high);
    if (kind === "mean") {
      const V = amplitude > 0 ? inside(x, [CURVE_LOW, CURVE_HIGH]) * amplitude : inside(x, [1e-6, 10]);
      this.change({ V }, "V");
    } else if (amplitude > 0) {
      const moved = this.unlessRefused(() => sceneAt(this.fmu, this.full(), inside(x, MAP.kappa), inside(y, MAP.zeta)));
      if (!moved) return; // the scene that was to be moved is refused
      const name = stiffnessName(moved);
      this.change({ V: moved.V, [name]: moved[name] }, "V");
    }
  }

  // The scene with the variables that the figures ask for by name, also where they are at their start.
  full() {
    const named = ["vibration.V_1", "vibration.V_2", "friction.limit", "contact.model"];
    return { ...Object.fromEntries(named.map((name) => [name, this.valueOf(name)])), ...this.values };
  }

  // One picture a frame, however often a slider moves.
  refresh() {
    document.body.dataset.address = "busy";
    if (!this.frame) this.frame = requestAnimationFrame(() => this.show());
  }

  show() {
    this.frame = 0;
    for (const [name, control] of this.controls) {
      control.show(this.valueOf(name));
      control.root.hidden = !control.matters((other) => this.valueOf(other));
    }
    if (this.unlessRefused(() => this.compute())) {
      this.accepted = { values: { ...this.values }, preset: this.preset };
      document.body.classList.remove("refused");
      setText("refusal", this.wrong);
    }
    this.showScene();
    if (this.pictured) {
      clearTimeout(this.settling);
      this.settling = setTimeout(() => this.showAddress(), PAUSE);
    }
    this.pictured = true;
  }

  // What work gives; what the FMU refuses in it is shown, and null given.
  unlessRefused(work) {
    try {
      return work();
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      this.refuse(error);
      return null;
    }
  }

  compute() {
    const values = this.full();
    const shown = wave(this.fmu, values);
    const here = regime(this.fmu, values);
    const without = steadyForce(this.fmu, values);
    const V_1 = this.valueOf("vibration.V_1");
    const V = this.valueOf("V");
    const amplitude = V_1 || !swing(values) ? "1" : "2";
    const known = this.hasConstantLimit() ? rigid(values) : null;
    this.state = { wave: shown, here: { ratio: here.zeta, V, mean: shown.mean, without, amplitude, rigid: known } };
    this.figures.showNumbers(shown, here, without, isPlane(values));
    this.figures.showWave(shown, here, V_1, isPlane(values));
    this.figures.showMean(this.state.here, this.preset?.measured);
    this.figures.showRegime(here, amplitude);
    this.ask(values);
    return this.state;
  }

  // Whether the friction of steady sliding depends on nothing.
  hasConstantLimit() {
    const hasStribeck = this.valueOf("friction.model") === "LuGre" && this.valueOf("friction.staticRatio") > 1;
    return this.valueOf("friction.limit") === "Constant" && !hasStribeck && this.valueOf("friction.sigma_2") === 0;
  }

  // At the control that was moved; for a scene that came whole, at the one that the message names.
  refuse(error) {
    const named = [...this.controls.keys()]
      .filter((name) => new RegExp(`(^|[^\\w.])${name.replace(".", "\\.")}($|[^\\w.])`).test(error.message))
      .sort((a, b) => b.length - a.length);
    const control = this.controls.get(this.touched ?? error.variable ?? named[0]);
    control?.refuse(error.message);
    if (control) control.root.hidden = false;
    document.body.classList.add("refused");
    setText("refusal", control ? "" : error.message);
  }

  // The name and the note of the scene.
  showScene() {
    const preset = this.preset;
    const same = preset && this.hashOf("", preset.values) === this.hashOf("", this.values);
    document.getElementById("preset").value = preset?.id ?? "";
    setText("changed", preset && !same ? "changed" : "");
    setHtml("note", preset?.note ?? "");
    document.getElementById("known").closest("div").hidden = !preset?.known;
    if (preset?.known) {
      setText("known-from", preset.known_from);
      setNumber("known", preset.known, "N");
    }
  }

  // The address of the scene and the texts to copy, once the hand rests.
  showAddress() {
    history.replaceState(null, "", this.hashOf(this.preset?.id, this.values));
    this.showCopy();
    document.body.dataset.address = "done";
  }

  hashOf(id, values) {
    const words = new URLSearchParams(id ? { preset: id } : {});
    for (const name of Object.keys(values).sort()) {
      if (values[name] !== this.fmu.variables.get(name)?.start) words.set(name, values[name]);
    }
    return `#${words}`;
  }

  // The scene of the address, or the first that shows what the page is for.
  restore() {
    const words = new URLSearchParams(location.hash.slice(1));
    const preset = presets.find(({ id }) => id === words.get("preset"));
    words.delete("preset");
    if (!preset && words.size === 0) {
      this.choose(presets.find(({ id }) => id === "table2-row2-identified") ?? presets[0]);
      return;
    }
    this.preset = preset ?? null;
    this.touched = null;
    const values = {};
    this.wrong = "";
    for (const [name, text] of words) {
      const variable = this.fmu.variables.get(name);
      const value = variable?.items ? text : numberOf(text);
      if (!variable) this.wrong = `${name} is no variable of this FMU`;
      else if (Number.isNaN(value)) this.wrong = `${name}: ${noNumber(text)}`;
      else values[name] = value;
    }
    this.load(words.size ? values : preset.values);
  }

  makeCopies() {
    const bar = document.getElementById("copy-kinds");
    for (const kind of Object.keys(COPIES)) {
      const button = element("button", { type: "button", textContent: kind, onclick: () => this.openCopy(kind) });
      button.dataset.kind = kind;
      bar.append(button);
    }
    document.getElementById("copy").addEventListener("click", async () => {
      const done = await copyText(document.getElementById("copy-text"));
      setText("copied", done ? "Copied." : "Press Ctrl+C to copy.");
    });
    this.openCopy(this.copyKind);
  }

  openCopy(kind) {
    this.copyKind = kind;
    for (const button of document.getElementById("copy-kinds").children) {
      button.setAttribute("aria-pressed", String(button.dataset.kind === kind));
    }
    this.showCopy();
  }

  // The last accepted scene, which is also what the figures show.
  showCopy() {
    if (!this.accepted) return;
    const refused = document.body.classList.contains("refused");
    setText("copied", refused ? "This is the last scene that the FMU accepted." : "");
    const { values, preset } = this.accepted;
    const valueOf = (name) => values[name] ?? this.fmu.variables.get(name)?.start;
    document.getElementById("copy-text").value = COPIES[this.copyKind]({
      name: preset?.title ?? "FrictionContact",
      values,
      valueOf,
      variables: this.fmu.variables,
      settles: valueOf("initialState") === "Settled",
      hash: this.hashOf(preset?.id, values),
      wave: this.state.wave,
    });
  }
}

// What scrolls sideways on a phone can be reached with the keyboard.
function reachable(element) {
  new ResizeObserver(() => {
    if (element.scrollWidth > element.clientWidth) element.tabIndex = 0;
    else element.removeAttribute("tabindex");
  }).observe(element);
}

function decoded(base64) {
  return Uint8Array.fromBase64?.(base64) ?? Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
}

// At once, so that the page is laid out with its picture in it; some browsers let only a worker do that.
async function compiled(base64) {
  const bytes = decoded(base64);
  try {
    return new WebAssembly.Module(bytes);
  } catch (error) {
    if (!(error instanceof RangeError)) throw error;
    return WebAssembly.compile(bytes);
  }
}

compiled(document.getElementById("wasm").textContent)
  .then((module) => new Page(module))
  .catch((error) => {
    setText("refusal", `This browser can't run the page: ${error.message}`);
    throw error;
  });
