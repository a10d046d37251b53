// The scene in words that other tools take: a command of fmpy, Python, a parameter set (.ssv), data, a link.
"use strict";

const FMU_FILE = "FrictionContact.fmu";
const STEPS_A_PERIOD = 200;

function escapeXml(text) {
  return text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
}

// scene: {name, values, valueOf, variables, settles, hash, wave}
const COPIES = {
  fmpy: ({ values, valueOf, variables }) => {
    const period = 1 / valueOf("vibration.f");
    const words = Object.entries(values).map(([name, value]) => `${name} ${itemNumber(variables.get(name), value)}`);
    const start = words.length ? ` --start-values ${words.join(" ")}` : "";
    return `fmpy simulate ${FMU_FILE}${start} --stop-time ${PERIODS_SHOWN * period} --output-interval ${period / STEPS_A_PERIOD} --show-plot`;
  },

  Python: ({ values, valueOf, variables, settles }) => {
    const lines = Object.entries(values).map(([name, value]) => {
      const remark = variables.get(name).items ? `  # ${value}` : "";
      return `    ${JSON.stringify(name)}: ${itemNumber(variables.get(name), value)},${remark}`;
    });
    const periods = settles ? PERIODS_SHOWN : 1000;
    return [
      "from fmpy import simulate_fmu",
      "",
      "start_values = {",
      ...lines,
      "}",
      `period = 1 / ${valueOf("vibration.f")}  # s`,
      `result = simulate_fmu("${FMU_FILE}", start_values=start_values, stop_time=${periods} * period,`,
      '                      output_interval=period, output=["F_t_mean"])',
      'print(result["F_t_mean"][-1], "N")',
    ].join("\n");
  },

  ".ssv": ({ name, values, variables }) => {
    const parameters = Object.entries(values).map(([variable, value]) => {
      const type = variables.get(variable).items ? "Enumeration" : "Real";
      return `    <ssv:Parameter name="${variable}"><ssv:${type} value="${value}"/></ssv:Parameter>`;
    });
    return [
      '<?xml version="1.0" encoding="UTF-8"?>',
      '<ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues"',
      `    version="1.0" name="${escapeXml(name)}">`,
      "  <ssv:Parameters>",
      ...parameters,
      "  </ssv:Parameters>",
      "</ssv:ParameterSet>",
    ].join("\n");
  },

  CSV: ({ wave: { time, velocity, displacement, force, transverse } }) =>
    ["time_s,velocity_m_per_s,displacement_m,F_t_N,F_y_N"]
      .concat(Array.from(time, (t, k) => [t, velocity[k], displacement[k], force[k], transverse[k]].join(",")))
      .join("\n"),

  Link: ({ hash }) => location.href.split("#")[0] + hash,
};

// The browser's clipboard where the page may use it; the field itself stays selected for a person to copy.
async function copyText(field) {
  field.select();
  try {
    await navigator.clipboard.writeText(field.value);
    return true;
  } catch {
    return document.execCommand("copy");
  }
}
