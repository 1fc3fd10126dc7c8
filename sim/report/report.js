// SPDX-License-Identifier: Apache-2.0
"use strict";

/** Builds the page from the embedded data: which curves stand in which chart, the choices, and what follows what. */
(() => {
  const { LinkedCharts, drawBand, drawStrip, element, colour } = charts;
  const data = JSON.parse(document.getElementById("report-data").textContent);
  const byId = (id) => document.getElementById(id);
  const force = (value) => `${value.toFixed(0)} N`;
  const axes = {
    time: { ...data.charts.time, name: "time, s", column: "time", format: (value) => `${value.toFixed(2)} s` },
    path: { ...data.charts.path, name: "path, mm", column: "path", format: (value) => `${value.toFixed(1)} mm` },
  };
  const state = {
    axis: axes.path,
    baseline: Math.max(data.runs.findIndex((run) => run.name === "constant"), data.runs.length > 1 ? 1 : 0),
    feedAs: "override_percent",
    level: -1,
  };

  /** One of several: buttons of which one is pressed. */
  function makeChoice(host, options, chosen, onChoice) {
    host.textContent = "";
    for (const [value, label] of options) {
      const button = host.appendChild(element("button", "", label));
      button.type = "button";
      button.setAttribute("aria-pressed", String(value === chosen));
      button.addEventListener("click", () => {
        for (const other of host.children) other.setAttribute("aria-pressed", String(other === button));
        onChoice(value);
      });
    }
  }

  /** A column of the compared run below, the controlled run's above it. */
  function runSeries(axis, column, format) {
    const series = [];
    if (state.baseline > 0) {
      series.push({ label: data.runs[state.baseline].name, values: axis.runs[state.baseline][column],
        colour: "compared", width: 1.2, format });
    }
    series.push({ label: data.runs[0].name, values: axis.runs[0][column], colour: "controlled", width: 1.4, format });
    return series;
  }

  const largest = (series) => series.reduce((top, one) =>
    (one.values || one.perBucket || [one.constant]).reduce((a, b) => (b !== null && b > a ? b : a), top), 0);

  function forceCharts(linked) {
    const limit = data.scenario.tooth_force_limit_N;
    linked.add({
      host: byId("tooth-force"),
      unit: "N",
      series: (axis) => [...runSeries(axis, "tooth_force_N", force),
        { label: "limit of a tooth", constant: limit, colour: "truth", width: 1.6, dash: [7, 4], format: force }],
      top: (series) => 1.08 * largest(series),
      underlay: (context, area, graph) => {
        context.fillStyle = colour("forbidden");
        context.fillRect(area.x, area.y, area.w, graph.toDomYCoord(limit) - area.y);
      },
    });
    linked.add({
      host: byId("total-force"),
      unit: "N",
      series: (axis) => {
        const run = axis.runs[0];
        return [
          { label: "estimated", values: run.estimated_peak_force_N, colour: "estimated-force", width: 1.1,
            format: force },
          { label: "true", values: run.peak_force_N, colour: "controlled", width: 1.3, format: force },
          { label: "limit here", perBucket: run.force_limit_N, colour: "truth", width: 1.6, dash: [7, 4],
            format: force },
        ];
      },
      top: (series) => 1.08 * largest(series),
    });
  }

  function stateLegend(host) {
    const legend = host.appendChild(element("div", "legend states"));
    const used = new Set(axes.time.runs[0].states);
    data.state_names.forEach((name, k) => {
      if (!used.has(String(k))) return;
      const entry = legend.appendChild(element("span", "entry"));
      const swatch = entry.appendChild(element("span", "swatch"));
      swatch.style.background = `var(--state-${name})`;
      entry.append(element("span", "", name.replace("_", " ")));
    });
  }

  function feedChart(linked, redraw) {
    const host = byId("feed");
    const choice = host.insertBefore(element("div", "choice"), host.querySelector(".how").nextSibling);
    choice.setAttribute("role", "group");
    choice.setAttribute("aria-label", "Feed shown as");
    const options = [["override_percent", "Override, %"], ["feed_mm_min", "Feed, mm/min"]];
    makeChoice(choice, options, state.feedAs, (value) => {
      state.feedAs = value;
      redraw();
    });
    const spec = {
      host,
      get unit() { return state.feedAs === "override_percent" ? "%" : "mm/min"; },
      series: (axis) => runSeries(axis, state.feedAs, (value) => `${value.toFixed(0)} ${spec.unit}`),
      top: (series) => 1.06 * largest(series),
      underlay: (context, area, graph, axis) =>
        drawStrip(context, area, graph, axis, axis.runs[0].states, (digit) => `state-${data.state_names[digit]}`),
      note: (row, axis) => {
        const digit = (text) => parseInt(text[row >> 1], 36);
        const { states, limits } = axis.runs[0];
        if (states[row >> 1] === ".") return "";
        const limit = digit(limits) > 0 ? `, held by ${data.limit_names[digit(limits)]}` : "";
        return `${data.state_names[digit(states)]}${limit}`.replaceAll("_", " ");
      },
    };
    linked.add(spec);
    stateLegend(host);
  }

  function estimateChart(linked, id, unit, columns, roof) {
    const format = (value) => `${value.toFixed(2)}${unit === "mm" ? " mm" : ""}`;
    linked.add({
      host: byId(id),
      unit,
      series: (axis) => [
        { label: "estimated, with its 95 % band", values: axis.runs[0][columns.estimate], colour: "estimate",
          width: 1.4, banded: true, format },
        { label: "true", values: axis.runs[0][columns.truth], colour: "truth", width: 1.3, format },
      ],
      top: (series) => Math.min(roof, 1.4 * largest(series)) || roof,
      underlay: (context, area, graph, axis) =>
        drawBand(context, area, graph, axis, axis.runs[0][columns.low], axis.runs[0][columns.high]),
    });
  }

  function makeViews(onPoint) {
    if (!data.scenario.stock_mm) return null;
    byId("top-view-section").hidden = false;
    const paths = data.runs.map((run) => topViews.decodedPath(run.path));
    const levels = topViews.levelsOf(paths[0]);
    const host = byId("top-views");
    const views = [new topViews.TopView(host, data.scenario, onPoint)];
    if (data.runs.length > 1) views.push(new topViews.TopView(host, data.scenario, onPoint));
    const show = () => views.forEach((view, k) => {
      const run = k === 0 ? 0 : state.baseline;
      view.show(paths[run], data.runs[run].name, levels, state.level);
    });
    if (levels.length > 1) {
      const options = [[-1, "All levels"], ...levels.map((z, k) => [k, `z ${z.toFixed(1)} mm`.replace("-", "−")])];
      makeChoice(byId("level-choice"), options, -1, (level) => {
        state.level = level;
        show();
      });
    }
    const scale = byId("force-scale");
    const ticks = element("div", "ticks");
    for (const share of [0, 25, 50, 75, 100]) ticks.append(element("span", "", `${share} %`));
    scale.append(element("div", "ramp"), element("div", "above"), ticks, element("div", "", "over limit"));
    return { views, show };
  }

  function main() {
    let linked = null;
    const top = makeViews((hit) => {
      if (hit) linked.setCursor(linked.rowAt(hit.view.run[state.axis.column][hit.index]), null);
      else linked.clearCursor();
      if (hit) markViews(hit.view.run[state.axis.column][hit.index]);
    });
    const markViews = (position) => {
      if (top) top.views.forEach((view) => view.mark(view.indexAt(state.axis.column, position)));
    };
    linked = new LinkedCharts((position) => markViews(position));
    const redraw = () => {
      charts.forgetColours();
      if (top) top.show();
      linked.show(state.axis);
    };
    forceCharts(linked);
    feedChart(linked, redraw);
    estimateChart(linked, "immersion", "a<sub>e</sub>/R", { estimate: "radial_immersion",
      truth: "true_radial_immersion", low: "radial_immersion_low", high: "radial_immersion_high" }, 2.1);
    estimateChart(linked, "depth", "mm", { estimate: "axial_depth_mm", truth: "true_axial_depth_mm",
      low: "axial_depth_low_mm", high: "axial_depth_high_mm" }, Infinity);
    makeChoice(byId("axis-choice"), [["path", "Over path"], ["time", "Over time"]], "path", (name) => {
      state.axis = axes[name];
      redraw();
    });
    makeBaselineChoice(redraw);
    byId("reset-zoom").addEventListener("click", () => linked.reset());
    redraw();
    charts.followWindow(redraw);
  }

  function makeBaselineChoice(redraw) {
    if (data.runs.length < 3) return;
    const label = byId("baseline-choice");
    const select = label.querySelector("select");
    data.runs.slice(1).forEach((run, k) => {
      const option = select.appendChild(element("option", "", run.name));
      option.value = k + 1;
    });
    select.value = state.baseline;
    select.addEventListener("change", () => {
      state.baseline = Number(select.value);
      redraw();
    });
    label.hidden = false;
  }

  main();
})();
