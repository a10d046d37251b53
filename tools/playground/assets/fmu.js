// The FMU as a page or a worker sees it: WebAssembly without imports, called through the FMI 2.0 functions.
"use strict";

class Refusal extends Error {
  // The FMU's own message; name is the variable that was being set, or null.
  constructor(message, name) {
    super(message);
    this.name = "Refusal";
    this.variable = name;
  }
}

// The number of an enumeration's item; any other value itself.
function itemNumber(variable, value) {
  return variable.items ? variable.items.findIndex((item) => item.name === value) + 1 : value;
}

class Fmu {
  // module: the WebAssembly.Module; description: modelDescription.xml as JSON.
  constructor(module, description) {
    const core = new WebAssembly.Instance(module).exports;
    core._initialize();
    this.core = core;
    this.variables = new Map(description.variables.map((variable) => [variable.name, variable]));
    this.component = core.host_instantiate();
    if (!this.component) throw new Error("the FMU can't be instantiated");
    this.numbersAt = core.host_numbers();
    this.referencesAt = core.host_references();
    this.time = 0;
  }

  // A fresh start: values maps names to SI numbers, or to the name of an enumeration's item.
  start(values) {
    this.call("fmi2Reset");
    for (const [name, value] of Object.entries(values)) this.set(name, value);
    this.call("fmi2SetupExperiment", 0, 0, 0, 0, 0);
    this.call("fmi2EnterInitializationMode");
    this.call("fmi2ExitInitializationMode");
    this.time = 0;
  }

  set(name, value) {
    const variable = this.variables.get(name);
    if (!variable) throw new Refusal(`${name} is no variable of this FMU`, name);
    const view = this.view();
    view.setUint32(this.referencesAt, variable.reference, true);
    if (variable.items) view.setInt32(this.numbersAt, itemNumber(variable, value), true);
    else view.setFloat64(this.numbersAt, value, true);
    const set = this.core[variable.items ? "fmi2SetInteger" : "fmi2SetReal"];
    if (set(this.component, this.referencesAt, 1, this.numbersAt) > 1) throw new Refusal(this.message(), name);
  }

  // Advances by h [s].
  step(h) {
    this.call("fmi2DoStep", this.time, h, 0);
    this.time += h;
  }

  get(name) {
    return this.read([name])[0];
  }

  read(names) {
    this.choose(names);
    return Array.from(this.again(names.length));
  }

  // Chooses what again(count) reads; the array that it gives is overwritten by the next call.
  choose(names) {
    const view = this.view();
    names.forEach((name, k) => view.setUint32(this.referencesAt + 4 * k, this.variables.get(name).reference, true));
  }

  again(count) {
    this.call("fmi2GetReal", this.referencesAt, count, this.numbersAt);
    return new Float64Array(this.core.memory.buffer, this.numbersAt, count);
  }

  call(name, ...parameters) {
    if (this.core[name](this.component, ...parameters) > 1) throw new Refusal(this.message(), null);
  }

  message() {
    const bytes = new Uint8Array(this.core.memory.buffer, this.core.host_message());
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  // The memory may have grown since the last call, which takes the old view away.
  view() {
    return new DataView(this.core.memory.buffer);
  }
}
