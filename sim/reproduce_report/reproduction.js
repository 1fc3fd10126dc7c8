// SPDX-License-Identifier: Apache-2.0
"use strict";

/** Draws the plots of reproduce.html: lines, points and bands, each series with x values of its own. */
(() => {
  const { element, colour, forgetColours, interactionModel } = charts;
  const plots = JSON.parse(document.getElementById("plots-data").textContent);
  const seriesColours = 8;
  const dashes = [null, [7, 4], [2, 3], [10, 3, 2, 3]];

  /** "Ø10 mm, model" and "Ø10 mm, tests" belong together: the same colour, different style or dash. */
  const familyOf = (name) => {
    const end = name.lastIndexOf(", ");
    return end > 0 ? name.slice(0, end) : name;
  };

  /** Gives each series its colour, dash and marker. Points never share a colour with other points. */
  function styled(series) {
    const families = new Map();
    let next = 0;
    return series.map((one) => {
      if (one.style.startsWith("band")) return { ...one, colour: "band" };
      if (one.name === "true") return { ...one, colour: "truth", dash: null, marker: 0, width: 1.2 };
      const family = familyOf(one.name);
      const points = one.style === "points";
      let place = families.get(family);
      if (!place || (points && place.points > 0)) {
        place = { index: next++, lines: 0, points: 0 };
        families.set(family, place);
      }
      const nth = points ? place.points++ : place.lines++;
      return { ...one, colour: `series-${place.index % seriesColours}`, dash: points ? null : dashes[nth % dashes.length],
        marker: place.index, width: 1.6 };
    });
  }

  /** Rows for dygraphs: one per x, or more where a series has several values there. undefined: no point of this
   *  series, a line passes; NaN: a gap. */
  function rowsOf(drawn) {
    const byX = new Map();
    drawn.forEach((one, k) => one.x.forEach((x, i) => {
      if (x === null) return;
      if (!byX.has(x)) byX.set(x, []);
      const rows = byX.get(x);
      let row = rows.find((candidate) => candidate[k + 1] === null);
      if (!row) {
        row = [x, ...drawn.map(() => null)];
        rows.push(row);
      }
      row[k + 1] = one.y[i] === null ? NaN : one.y[i];
    }));
    return [...byX.entries()].sort((a, b) => a[0] - b[0]).flatMap(([, rows]) => rows);
  }

  const markers = [
    (c, x, y, r) => c.arc(x, y, r, 0, 2 * Math.PI),
    (c, x, y, r) => c.rect(x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r),
    (c, x, y, r) => { c.moveTo(x, y - 1.25 * r); c.lineTo(x + 1.15 * r, y + 0.85 * r); c.lineTo(x - 1.15 * r, y + 0.85 * r); },
    (c, x, y, r) => { c.moveTo(x, y - 1.3 * r); c.lineTo(x + 1.3 * r, y); c.lineTo(x, y + 1.3 * r); c.lineTo(x - 1.3 * r, y); },
  ];

  /** Series of points that mostly cover each other are drawn side by side: pixels to the right per series. True where
   *  they are. */
  function setOffsets(series) {
    const points = series.filter((one) => one.style === "points");
    const [low, high] = rangeOf(points, "y", 0);
    const covers = (a, b) => {
      const close = a.x.filter((x, i) => b.x.some((other, k) => other === x && Math.abs(b.y[k] - a.y[i]) < 0.03 * (high - low)));
      return close.length > 0.5 * a.x.length;
    };
    const crowded = points.some((a, i) => points.slice(i + 1).some((b) => covers(a, b)));
    points.forEach((one, k) => { one.offset = crowded ? 6 * (k - (points.length - 1) / 2) : 0; });
    return crowded;
  }

  function drawMarker(context, one, x, y, radius) {
    context.save();
    context.beginPath();
    markers[one.marker % markers.length](context, x + one.offset, y, radius);
    context.closePath();
    context.fillStyle = colour(one.colour);
    context.globalAlpha = 0.8;
    context.fill();
    context.restore();
  }

  /** The area between a lower and an upper bound, interrupted where one of them has a gap. */
  function drawBand(context, graph, low, high) {
    context.fillStyle = colour("band");
    const there = (k) => low.y[k] !== null && high.y[k] !== null;
    const count = Math.min(low.x.length, high.x.length);
    const at = (x, y) => context.lineTo(graph.toDomXCoord(x), graph.toDomYCoord(y));
    for (let first = 0; first < count; ++first) {
      if (!there(first)) continue;
      let end = first;
      while (end < count && there(end)) ++end;
      context.beginPath();
      for (let k = first; k < end; ++k) at(high.x[k], high.y[k]);
      for (let k = end - 1; k >= first; --k) at(low.x[k], low.y[k]);
      context.fill();
      first = end;
    }
  }

  function bandsOf(series) {
    const lows = series.filter((one) => one.style === "band_low");
    const highs = series.filter((one) => one.style === "band_high");
    return lows.map((low, k) => ({ low, high: highs[k] })).filter((band) => band.high);
  }

  /** [smallest, largest] of a column over all series, with a margin. Lines may start on the axis, points may not: half
   *  of each would be hidden. */
  function rangeOf(series, column, margin) {
    const values = (wanted) => series.filter(wanted).flatMap((one) => one[column]).filter((value) => value !== null);
    const all = values(() => true);
    if (all.length === 0) return [0, 1];
    const low = Math.min(...all);
    const high = Math.max(...all);
    const room = margin * (high - low || Math.abs(high) || 1);
    const pointsNearAxis = values((one) => one.style === "points").some((value) => value < low + room);
    return [low >= 0 && low - room < 0 && !pointsNearAxis ? 0 : low - room, high + room];
  }

  /** Names that are lists of conditions, "200 rpm, Ø100, SM45C": what all have in common is said once. */
  function shortened(drawn) {
    const points = drawn.filter((one) => one.style === "points");
    const parts = points.map((one) => one.name.split(", "));
    const count = parts.length > 1 ? parts[0].length : 0;
    if (count < 3 || parts.some((list) => list.length !== count)) return { labels: new Map(), shared: "" };
    const differs = parts[0].map((part, i) => parts.some((list) => list[i] !== part));
    const labels = new Map(points.map((one, k) => [one, parts[k].filter((part, i) => differs[i]).join(", ")]));
    return { labels, shared: parts[0].filter((part, i) => !differs[i]).join(", ") };
  }

  const ns = "http://www.w3.org/2000/svg";
  function sample(one) {
    const svg = document.createElementNS(ns, "svg");
    svg.setAttribute("width", one.style === "points" ? "14" : "26");
    svg.setAttribute("height", "14");
    svg.setAttribute("aria-hidden", "true");
    const shape = (name, attributes) => {
      const made = svg.appendChild(document.createElementNS(ns, name));
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    };
    const stroke = `var(--${one.colour})`;
    if (one.style === "points") {
      const outlines = [["circle", { cx: 7, cy: 7, r: 4.5 }], ["rect", { x: 3, y: 3, width: 8, height: 8 }],
        ["path", { d: "M7 1.5 12.5 11H1.5Z" }], ["path", { d: "M7 1 13 7 7 13 1 7Z" }]];
      const [name, attributes] = outlines[one.marker % outlines.length];
      shape(name, { ...attributes, style: `fill: ${stroke}` });
    } else if (one.style === "line") {
      shape("line", { x2: 26, y1: 7, y2: 7, "stroke-width": one.width + 0.6, style: `stroke: ${stroke}`,
        "stroke-dasharray": (one.dash || []).join(" ") });
    } else {
      shape("rect", { width: 26, height: 14, style: "fill: var(--band)" });
    }
    return svg;
  }

  const readable = (value) => Math.abs(value) >= 1000 ? value.toFixed(0) : String(Number(value.toPrecision(4)));

  /** One entry per series; a band is one entry, by its bounds' common name. Returns where each value is shown. */
  function makeLegend(host, drawn, bands) {
    const entry = (one, label) => {
      const made = host.appendChild(element("span", "entry"));
      made.append(sample(one), element("span", "", label));
      return made.appendChild(element("span", "value"));
    };
    for (const { low, high } of bands) {
      let same = 0;
      while (same < low.name.length && low.name[same] === high.name[same]) ++same;
      const common = low.name.slice(0, low.name.lastIndexOf(" ", same)).replace(/[,:]?\s*$/, "");
      entry(low, common || `${low.name} – ${high.name}`);
    }
    const { labels, shared } = shortened(drawn);
    const values = drawn.map((one) => entry(one, labels.get(one) || one.name));
    if (shared) host.appendChild(element("span", "shared", `all: ${shared}`));
    return { values, note: host.appendChild(element("span", "position")) };
  }

  function draw(id, plot) {
    const host = document.getElementById(id);
    host.textContent = "";
    const series = styled(plot.series);
    const crowded = setOffsets(series);
    const drawn = series.filter((one) => !one.style.startsWith("band"));
    const bands = bandsOf(series);
    const legend = makeLegend(host.appendChild(element("div", "legend")), drawn, bands);
    const rows = rowsOf(drawn);
    const ranges = { dateWindow: rangeOf(series, "x", crowded ? 0.05 : 0.03), valueRange: rangeOf(series, "y", 0.06) };
    const showRow = (row) => {
      drawn.forEach((one, k) => {
        const value = rows[row][k + 1];
        legend.values[k].textContent = value === null || Number.isNaN(value) ? "" : readable(value);
      });
      legend.note.textContent = `at ${readable(rows[row][0])}`;
    };
    const clear = () => {
      for (const value of legend.values) value.textContent = "";
      legend.note.textContent = "";
    };
    const escaped = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;");
    const graph = new Dygraph(host.appendChild(element("div", "plot")), rows, {
      labels: ["x", ...drawn.map((one, k) => `${k}`)],
      colors: drawn.map((one) => colour(one.colour)),
      series: Object.fromEntries(drawn.map((one, k) => [`${k}`, one.style === "points"
        ? { strokeWidth: 0, drawPoints: true, pointSize: 3.6,
          drawPointCallback: (g, name, context, x, y, c, radius) => drawMarker(context, one, x, y, radius),
          drawHighlightPointCallback: (g, name, context, x, y, c, radius) => drawMarker(context, one, x, y, radius + 1) }
        : { strokeWidth: one.width, strokePattern: one.dash }])),
      connectSeparatedPoints: true,
      ...ranges,
      legend: "never",
      xlabel: escaped(plot.x_label),
      ylabel: escaped(plot.y_label),
      xLabelHeight: 18,
      yLabelWidth: 18,
      axes: {
        x: { axisLabelFontSize: 12, axisLabelWidth: 40, pixelsPerLabel: 42, drawGrid: false, valueFormatter: readable },
        y: { axisLabelFontSize: 12, axisLabelWidth: 46, pixelsPerLabel: 34 },
      },
      axisLineColor: colour("line"),
      gridLineColor: colour("grid"),
      rightGap: 20,
      highlightCircleSize: 3.5,
      animatedZooms: false,
      interactionModel: interactionModel(() => graph.updateOptions(ranges)),
      underlayCallback: (context, area, g) => {
        context.save();
        context.beginPath();
        context.rect(area.x, area.y, area.w, area.h);
        context.clip();
        for (const { low, high } of bands) drawBand(context, g, low, high);
        context.restore();
      },
      highlightCallback: (event, x, points, row) => showRow(row),
      unhighlightCallback: clear,
    });
  }

  function redraw() {
    forgetColours();
    for (const [id, plot] of Object.entries(plots)) draw(id, plot);
  }

  redraw();
  charts.followWindow(redraw);
})();
