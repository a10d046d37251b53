// Numbers and units as people write them; the scene itself is kept in SI.
"use strict";

const UNIT_TEXT = { um: "µm", mm2: "mm²", deg: "°", "1": "", "N.s/m": "N s/m", "1/m2": "1/m²" };

function unitText(variable) {
  return UNIT_TEXT[variable.displayUnit] ?? variable.displayUnit;
}

// The number that a person wrote in the usual way, or NaN: no hexadecimal, no comma, which has two meanings.
function numberOf(text) {
  const written = text.trim().replace("−", "-");
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(written) ? Number(written) : NaN;
}

// What is told of a text that numberOf does not take.
function noNumber(text) {
  const hint = text.includes(",") ? ": write the decimal point as ., and no sign between thousands" : "";
  return `${text.trim() || "an empty field"} is not a number${hint}`;
}

// A number that an input field and Number() understand, with at most 6 significant digits.
function plain(value) {
  return Number.isFinite(value) ? String(Number(value.toPrecision(6))).replace("e+", "e") : "";
}

// A number to read: 4 digits, true minus, powers of ten.
function readable(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e6 || size < 1e-3)) {
    const exponent = Math.floor(Math.log10(size));
    const raised = String(exponent).replace(/[-\d]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
    return `${readable(value / 10 ** exponent)}·10${raised}`;
  }
  return String(Number(value.toPrecision(4))).replace("-", "−");
}

function withUnit(value, unit) {
  const gap = unit === "" || unit === "°" ? "" : "\u202f";
  return `${readable(value)}${gap}${unit}`;
}
