// Sliders, fields and choices, one for each variable that the FMU has. A control knows its value in SI.
"use strict";

const STEPS = 1000; // of a slider
const DIGITS = 3; // of a value that a slider sets, in the unit shown

class Control {
  // spec: a line of controls.json; changed(name, value) is called when a person sets a value.
  constructor(spec, variable, changed) {
    this.spec = spec;
    this.variable = variable;
    this.changed = (value) => changed(variable.name, value);
    const template = document.getElementById(variable.items ? "choice" : "quantity");
    this.root = template.content.firstElementChild.cloneNode(true);
    this.root.dataset.variable = variable.name;
    this.error = this.root.querySelector(".refusal");
    this.error.id = `refusal-${variable.name}`;
    this.root.querySelector(".symbol").innerHTML = spec.symbol;
    this.root.querySelector(".words").textContent = spec.words;
    this.root.title = variable.description;
    variable.items ? this.makeChoice() : this.makeQuantity();
  }

  makeChoice() {
    this.field = this.root.querySelector("select");
    this.link(this.field);
    this.field.append(...this.variable.items.map((item) => new Option(item.name)));
    this.field.addEventListener("change", () => this.changed(this.field.value));
  }

  makeQuantity() {
    this.field = this.root.querySelector("input[type=text]");
    this.slider = this.root.querySelector("input[type=range]");
    this.link(this.field);
    this.slider.max = STEPS;
    this.slider.setAttribute("aria-label", this.spec.words);
    this.slider.setAttribute("aria-describedby", this.error.id);
    this.root.querySelector(".unit").textContent = unitText(this.variable);
    this.slider.addEventListener("input", () => this.changed(this.fromSlider(Number(this.slider.value))));
    this.field.addEventListener("change", () => this.fromField());
  }

  link(field) {
    field.id = `field-${this.variable.name}`;
    field.setAttribute("aria-describedby", this.error.id);
    this.root.querySelector("label").htmlFor = field.id;
  }

  // What is no number is told here; every number is the FMU's to judge.
  fromField() {
    const value = numberOf(this.field.value);
    if (Number.isNaN(value)) this.refuse(noNumber(this.field.value));
    else this.changed(value / this.variable.factor);
  }

  fromSlider(step) {
    const { low, high, scale, off } = this.spec;
    if (off && step === 0) return 0;
    const part = step / STEPS;
    const value = scale === "log" ? low * (high / low) ** part : low + part * (high - low);
    return Number((value * this.variable.factor).toPrecision(DIGITS)) / this.variable.factor;
  }

  toSlider(value) {
    const { low, high, scale, off } = this.spec;
    if (scale === "linear") return (STEPS * (value - low)) / (high - low);
    if (!(value > 0)) return 0;
    return Math.max((STEPS * Math.log(value / low)) / Math.log(high / low), off ? 1 : 0);
  }

  show(value) {
    this.refuse("");
    if (value === this.shown) return;
    this.shown = value;
    if (this.variable.items) {
      this.field.value = value;
      return;
    }
    const shown = value * this.variable.factor;
    if (document.activeElement !== this.field || Number(this.field.value) !== shown) this.field.value = plain(shown);
    this.slider.value = this.toSlider(value);
    this.slider.setAttribute("aria-valuetext", withUnit(shown, unitText(this.variable)));
  }

  refuse(message) {
    if (message === this.error.textContent) return;
    this.shown = undefined; // a field that was refused is written anew
    this.error.textContent = message;
    this.root.classList.toggle("refused", message !== "");
    this.field.setAttribute("aria-invalid", String(message !== ""));
  }

  // Whether the variable has an effect in this scene.
  matters(valueOf) {
    return Object.entries(this.spec.when).every(([name, items]) => {
      const value = valueOf(name);
      return value === undefined || items.includes(value);
    });
  }
}
