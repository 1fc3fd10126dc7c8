// SPDX-License-Identifier: Apache-2.0
"use strict";

/** Draws the charts of a part map from the embedded data. */
(() => {
  const { LinkedCharts, drawBand, drawStrip, element } = charts;
  const data = JSON.parse(document.getElementById("map-data").textContent);
  const byId = (id) => document.getElementById(id);
  const axis = { ...data, name: "path, mm", format: (value) => `${value.toFixed(1)} mm` };
  const stripColours = ["state-air", "state-in_cut", "state-entry", "state-hold", "state-fault"];
  const colourOf = (digit) => stripColours[digit];
  const largest = (values) => values.reduce((a, b) => (b !== null && b > a ? b : a), 0);
  const known = (row) => data.known_names[parseInt(data.known[row >> 1], 10)];

  function stripLegend(host) {
    const legend = host.appendChild(element("div", "legend states"));
    const used = new Set(data.known);
    data.known_names.forEach((name, k) => {
      if (!used.has(k.toString())) return;
      const entry = legend.appendChild(element("span", "entry"));
      entry.appendChild(element("span", "swatch")).style.background = `var(--${colourOf(k)})`;
      entry.append(element("span", "", name));
    });
  }

  function loadChart(linked) {
    const host = byId("load");
    const force = (value) => `${value.toFixed(0)} N`;
    linked.add({
      host,
      unit: "N",
      series: () => [
        { label: "force on a tooth at the programmed feed", perBucket: data.tooth_force_N, colour: "controlled", width: 1.4,
          format: force },
        { label: "its limit", constant: data.tooth_force_limit_N, colour: "truth", width: 1.6, dash: [7, 4], format: force },
      ],
      top: () => 1.08 * Math.max(largest(data.tooth_force_N), data.tooth_force_limit_N),
      underlay: (context, area, graph) => drawStrip(context, area, graph, axis, data.known, colourOf),
      note: known,
    });
    stripLegend(host);
  }

  function mapChart(linked, id, unit, name, roof) {
    const [low, high] = id === "depth" ? ["depth_low_mm", "depth_high_mm"] : ["immersion_low", "immersion_high"];
    linked.add({
      host: byId(id),
      unit,
      series: () => [{ label: "by the map, with its 95 % band", perBucket: data[name], colour: "estimate", width: 1.4,
        banded: true, format: (value) => `${value.toFixed(2)}${unit === "mm" ? " mm" : ""}` }],
      top: () => Math.min(roof, 1.2 * largest(data[high])) || 1,
      underlay: (context, area, graph) => drawBand(context, area, graph, axis, data[low], data[high]),
      note: known,
    });
  }

  function main() {
    if (data.buckets === 0) {
      document.querySelector(".charts").hidden = true;
      return;
    }
    const linked = new LinkedCharts(() => {});
    loadChart(linked);
    mapChart(linked, "immersion", "a<sub>e</sub>/R", "immersion", 2.1);
    mapChart(linked, "depth", "mm", "depth_mm", Infinity);
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
