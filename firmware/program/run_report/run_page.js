// SPDX-License-Identifier: Apache-2.0
"use strict";

/** Draws the charts of a run from the embedded data. */
(() => {
  const { LinkedCharts, drawBand, drawStrip, element, colour } = charts;
  const data = JSON.parse(document.getElementById("run-data").textContent);
  const byId = (id) => document.getElementById(id);
  /** Seconds are no unit for a day. */
  const [unit, unitSeconds] = data.length < 600 ? ["s", 1] : data.length < 18000 ? ["min", 60] : ["h", 3600];
  const axis = { ...data, length: data.length / unitSeconds, name: `time, ${unit}`,
    format: (value) => `${value.toFixed(2)} ${unit}` };
  const force = (value) => `${value.toFixed(0)} N`;
  const words = (name) => name.replaceAll("_", " ");
  const stateColour = (digit) => `state-${data.state_names[digit]}`;
  const limitColour = (digit) => `limit-${digit}`;

  const largest = (series) => series.reduce((top, one) =>
    (one.values || one.perBucket).reduce((a, b) => (b !== null && b > a ? b : a), top), 0);

  /** What the strip of a chart shows at a row; "" where there was no sample. */
  const stripText = (digits, names, row) => {
    const digit = digits[row >> 1];
    return digit === "." ? "" : words(names[parseInt(digit, 36)]);
  };

  function stripLegend(host, digits, names, colourOf) {
    const legend = host.appendChild(element("div", "legend states"));
    const used = new Set(digits);
    names.forEach((name, k) => {
      if (!used.has(k.toString(16))) return;
      const entry = legend.appendChild(element("span", "entry"));
      entry.appendChild(element("span", "swatch")).style.background = `var(--${colourOf(k)})`;
      entry.append(element("span", "", words(name)));
    });
  }

  /** Lines where a fault began. */
  function drawFaults(context, area, graph) {
    context.fillStyle = colour("over");
    for (const event of data.events) {
      if (event.fault) context.fillRect(graph.toDomXCoord(event.time_s / unitSeconds) - 1, area.y, 2, area.h);
    }
  }

  function loadChart(linked) {
    const host = byId("load");
    linked.add({
      host,
      unit: "N",
      series: () => [
        { label: "load on a tooth", values: data.tooth_force_N, colour: "controlled", width: 1.4, format: force },
        { label: "the most that it can have been", values: data.tooth_force_bound_N, colour: "compared", width: 1,
          format: force },
        { label: "its limit", perBucket: data.tooth_force_limit_N, colour: "truth", width: 1.6, dash: [7, 4],
          format: force },
      ],
      top: (series) => 1.08 * largest(series) || 1,
      underlay: (context, area, graph) => {
        drawStrip(context, area, graph, axis, data.states, stateColour);
        drawFaults(context, area, graph);
      },
      note: (row) => stripText(data.states, data.state_names, row),
    });
    stripLegend(host, data.states, data.state_names, stateColour);
  }

  function overrideChart(linked) {
    const host = byId("override");
    linked.add({
      host,
      unit: "%",
      series: () => [{ label: "override", values: data.override_percent, colour: "controlled", width: 1.4,
        format: (value) => `${value.toFixed(0)} %` }],
      top: (series) => 1.06 * largest(series) || 1,
      underlay: (context, area, graph) => {
        drawStrip(context, area, graph, axis, data.limits, limitColour);
        drawFaults(context, area, graph);
      },
      note: (row) => stripText(data.limits, data.limit_labels, row),
    });
    stripLegend(host, data.limits, data.limit_labels, limitColour);
  }

  function estimateChart(linked, id, unit, columns, roof) {
    linked.add({
      host: byId(id),
      unit,
      series: () => [{ label: "estimated, with its 95 % band", values: data[columns.estimate], colour: "estimate",
        width: 1.4, banded: true, format: (value) => `${value.toFixed(2)}${unit === "mm" ? " mm" : ""}` }],
      top: (series) => Math.min(roof, 1.4 * largest(series)) || Math.min(roof, 1),
      underlay: (context, area, graph) =>
        drawBand(context, area, graph, axis, data[columns.low], data[columns.high]),
    });
  }

  function main() {
    if (data.buckets === 0) {
      document.querySelector(".charts").hidden = true;
      return;
    }
    const linked = new LinkedCharts(() => {});
    loadChart(linked);
    overrideChart(linked);
    estimateChart(linked, "immersion", "a<sub>e</sub>/R",
      { estimate: "radial_immersion", low: "radial_immersion_low", high: "radial_immersion_high" }, 2.1);
    estimateChart(linked, "depth", "mm",
      { estimate: "axial_depth_mm", low: "axial_depth_low_mm", high: "axial_depth_high_mm" }, Infinity);
    const redraw = () => {
      charts.forgetColours();
      linked.show(axis);
    };
    byId("reset-zoom").addEventListener("click", () => linked.reset());
    redraw();
    charts.followWindow(redraw);
  }

  main();
})();
