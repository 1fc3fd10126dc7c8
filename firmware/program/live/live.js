// SPDX-License-Identifier: Apache-2.0
"use strict";

/** The telemetry of the last minute, as it comes. Names, units and meanings are those of /fields.json. */
(() => {
  const windowMs = 60000;
  const redrawMs = 200;
  const silentMs = 2000;
  const mostEvents = 30;

  /** `deviation`: the field with the standard deviation of the first line, drawn as its 95 % band. */
  const stripSpecs = [
    { title: "Load and threshold", lines: ["peak_force_N", "force_limit_N"] },
    { title: "Override", lines: ["override", "operator_override"] },
    { title: "Radial immersion", lines: ["radial_immersion"], deviation: "radial_immersion_sd" },
    { title: "Axial depth", lines: ["axial_depth_mm"], deviation: "axial_depth_sd_mm" },
    { title: "Forces", lines: ["tangential_force_N", "feed_force_N"] },
    { title: "Spindle current", lines: ["spindle_current_A"] },
  ];
  const colours = ["controlled", "compared"];

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const unitless = (field) => {
    const unit = `_${field.unit.replace("/", "_").replace("µ", "u")}`;
    return inWords(field.name.endsWith(unit) ? field.name.slice(0, -unit.length) : field.name);
  };

  let fields = [];
  const column = new Map();  // place of each field in a row; the time is at 0
  let rows = [];
  let newestRow = null;
  let heardAt = 0;

  function shown(field, value) {
    if (value === null || value === undefined) return "–";
    if (Array.isArray(value)) return value.length ? value.map(inWords).join(", ") : "none";
    if (typeof value === "boolean") return value ? "yes" : "no";
    if (typeof value === "string") return inWords(value);
    if (field.unit === "1") return value.toFixed(2);
    if (!field.unit) return String(value);
    return `${value.toFixed(Math.abs(value) >= 100 ? 0 : 2)} ${field.unit}`;
  }

  class Strip {
    constructor(spec) {
      this.places = spec.lines.map((name) => column.get(name));
      this.deviation = spec.deviation ? column.get(spec.deviation) : undefined;
      this.box = element("article", "strip");
      const head = element("header");
      head.append(element("h3", "", spec.title));
      this.readings = this.places.map((place, k) => {
        const reading = element("span", "reading");
        reading.style.color = colour(colours[k]);
        reading.title = fields[place - 1].meaning;
        head.append(reading);
        return reading;
      });
      const plot = element("div", "plot");
      this.box.append(head, plot);
      byId("strips").append(this.box);
      this.graph = new Dygraph(plot, [this.pointOf([0])], {
        labels: ["time", ...spec.lines],
        colors: this.places.map((place, k) => colour(colours[k])),
        customBars: this.deviation !== undefined,
        fillAlpha: 0.25,
        strokeWidth: 1.8,
        legend: "never",
        includeZero: true,
        yRangePad: 4,
        interactionModel: {},
        axisLineColor: colour("line"),
        gridLineColor: colour("grid"),
        axes: { x: { axisLabelFontSize: 12, drawGrid: false }, y: { axisLabelFontSize: 12, axisLabelWidth: 42 } },
      });
    }
    pointOf(row) {
      const values = this.places.map((place) => row[place] ?? null);
      if (this.deviation === undefined) return [new Date(row[0]), ...values];
      const half = 1.96 * (row[this.deviation] ?? 0);
      return [new Date(row[0]), ...values.map((v) => (v === null ? [null, null, null] : [v - half, v, v + half]))];
    }
    draw(newest) {
      this.graph.updateOptions({
        file: rows.map((row) => this.pointOf(row)),
        dateWindow: [newest[0] - windowMs, newest[0]],
      });
      this.places.forEach((place, k) => {
        const field = fields[place - 1];
        this.readings[k].textContent = `${unitless(field)} ${shown(field, newest[place])}`;
      });
    }
  }

  function showState(newest) {
    const at = (name) => newest[column.get(name)];
    byId("state").textContent = inWords(at("state"));
    byId("state").style.borderColor = colour(`state-${at("state")}`);
    byId("limit").textContent = inWords(at("limit"));
    byId("fault").textContent = inWords(at("fault"));
    byId("fault").className = at("fault") === "none" ? "" : "alarm";
    byId("hold").textContent = at("hold") ? "held" : "free";
    byId("hold").className = at("hold") ? "alarm" : "";
    byId("conditions").textContent = at("conditions").length ? at("conditions").map(inWords).join(", ") : "none";
  }

  function showConnection() {
    const silence = Date.now() - heardAt;
    byId("connection").textContent = !newestRow ? "Waiting for the first tick."
      : silence > silentMs ? `No tick for ${Math.round(silence / 1000)} s: what is below is old.`
      : `Live. Time of the samples: ${newestRow[column.get("time_s")].toFixed(1)} s`;
    byId("connection").classList.toggle("alarm", silence > silentMs);
  }

  function addEvent(event) {
    const item = element("li", event.level);
    item.append(element("time", "", new Date(event.unix_ms).toTimeString().slice(0, 8)), inWords(event.text));
    byId("events").prepend(item);
    while (byId("events").childElementCount > mostEvents) byId("events").lastElementChild.remove();
  }

  function begin(description) {
    fields = description.fields;
    fields.forEach((field, k) => column.set(field.name, k + 1));
    const cells = fields.map((field) => {
      const row = element("tr");
      const name = element("th", "", unitless(field));
      name.scope = "row";
      const value = element("td");
      row.title = field.meaning;
      row.append(name, value);
      byId("values").append(row);
      return value;
    });
    const strips = stripSpecs.map((spec) => new Strip(spec));
    let drawn = null;
    setInterval(() => {
      showConnection();
      if (!newestRow || drawn === newestRow || document.hidden) return;
      drawn = newestRow;
      for (const strip of strips) strip.draw(newestRow);
      showState(newestRow);
      cells.forEach((cell, k) => { cell.textContent = shown(fields[k], newestRow[k + 1]); });
    }, redrawMs);
    listen();
  }

  function listen() {
    const source = new EventSource("events");
    source.addEventListener("open", () => {  // it begins with the oldest that the server has
      rows = [];
      byId("events").replaceChildren();
    });
    source.addEventListener("rows", (message) => {
      rows.push(...JSON.parse(message.data));
      newestRow = rows[rows.length - 1];
      heardAt = Date.now();
      const first = rows.findIndex((row) => row[0] >= newestRow[0] - windowMs);
      if (first > 0) rows.splice(0, first);
    });
    source.addEventListener("event", (message) => addEvent(JSON.parse(message.data)));
  }

  fetch("fields.json").then((answer) => answer.json()).then(begin);
})();
