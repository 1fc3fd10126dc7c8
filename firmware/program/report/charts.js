// SPDX-License-Identifier: Apache-2.0
"use strict";

/** Charts along the run: linked zoom, linked cursor, one legend each. Drawn with dygraphs. */
const charts = (() => {
  /** The style sheet's colours; asked for once, until forgetColours(). */
  const known = new Map();
  const colour = (name) => {
    if (!known.has(name)) {
      known.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
    }
    return known.get(name);
  };
  const forgetColours = () => known.clear();

  const element = (tag, className, text) => {
    const made = document.createElement(tag);
    if (className) made.className = className;
    if (text !== undefined) made.textContent = text;
    return made;
  };

  /** A series has two values per bucket, or one (perBucket), or the same everywhere (constant). */
  const valueAt = (one, i) => one.values ? one.values[i] : one.perBucket ? one.perBucket[i >> 1] : one.constant;

  /** Rows for dygraphs: position and one value per series; two rows per bucket. */
  function rowsOf(axis, series) {
    const rows = new Array(2 * axis.buckets);
    for (let i = 0; i < rows.length; ++i) {
      const row = [((i + 0.5) * axis.length) / rows.length];
      for (const one of series) row.push(valueAt(one, i));
      rows[i] = row;
    }
    return rows;
  }

  function clipTo(context, area, draw) {
    context.save();
    context.beginPath();
    context.rect(area.x, area.y, area.w, area.h);
    context.clip();
    draw();
    context.restore();
  }

  /** The area between two columns with one value per bucket, interrupted where there is none. */
  function drawBand(context, area, graph, axis, low, high) {
    const left = (k) => graph.toDomXCoord((k * axis.length) / axis.buckets);
    const there = (k) => low[k] !== null && high[k] !== null;
    context.fillStyle = colour("band");
    for (let first = 0; first < low.length; ++first) {
      if (!there(first)) continue;
      let end = first;
      while (end < low.length && there(end)) ++end;
      context.beginPath();
      for (let k = first; k < end; ++k) {
        context.lineTo(left(k), graph.toDomYCoord(high[k]));
        context.lineTo(left(k + 1), graph.toDomYCoord(high[k]));
      }
      for (let k = end - 1; k >= first; --k) {
        context.lineTo(left(k + 1), graph.toDomYCoord(low[k]));
        context.lineTo(left(k), graph.toDomYCoord(low[k]));
      }
      context.fill();
      first = end;
    }
  }

  /** What held in each bucket (one hexadecimal digit, "." for nothing): a faint tint behind the curves and a strip of
   *  full colour at the foot. */
  function drawStrip(context, area, graph, axis, digits, colourOf) {
    const stripHeight = 9;
    for (let first = 0; first < digits.length; ) {
      let end = first + 1;
      while (end < digits.length && digits[end] === digits[first]) ++end;
      if (digits[first] !== ".") {
        const x = graph.toDomXCoord((first * axis.length) / axis.buckets);
        const width = graph.toDomXCoord((end * axis.length) / axis.buckets) - x;
        context.fillStyle = colour(colourOf(parseInt(digits[first], 36)));
        context.globalAlpha = 0.1;
        context.fillRect(x, area.y, width, area.h);
        context.globalAlpha = 1;
        context.fillRect(x, area.y + area.h - stripHeight, width, stripHeight);
      }
      first = end;
    }
  }

  function lineSample(one) {
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("width", "26");
    svg.setAttribute("height", "12");
    svg.setAttribute("aria-hidden", "true");
    const shape = (name, attributes) => {
      const made = svg.appendChild(document.createElementNS(svg.namespaceURI, name));
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    };
    if (one.banded) shape("rect", { width: 26, height: 12, style: "fill: var(--band)" });
    shape("line", {
      x2: 26, y1: 6, y2: 6, "stroke-width": one.width + 0.6, "stroke-dasharray": (one.dash || []).join(" "),
      style: `stroke: var(--${one.colour})`,
    });
    return svg;
  }

  /** Touch moves the page; two fingers zoom. The library's own habit would catch every swipe. */
  function interactionModel(showAll) {
    const model = Object.assign({}, Dygraph.defaultInteractionModel, { dblclick: showAll });
    for (const event of ["touchstart", "touchmove", "touchend"]) {
      const original = model[event];
      model[event] = (e, graph, context) => {
        if (e.touches.length > 1 || context.pinching) {
          context.pinching = e.touches.length > 1;
          original(e, graph, context);
        }
      };
    }
    return model;
  }

  class LinkedCharts {
    constructor(onCursor) {
      this.list = [];
      this.onCursor = onCursor;
      this.busy = false;
    }

    /** spec: { host, unit (HTML), series(axis), underlay(context, area, graph, axis),
     *  top(series): end of the vertical axis, note(row, axis): text beside the cursor's position } */
    add(spec) {
      const chart = { spec, legend: spec.host.appendChild(element("div", "legend")) };
      chart.plot = spec.host.appendChild(element("div", "plot"));
      this.list.push(chart);
    }

    /** (Re)draws all charts on an axis: { name: "time, s", length, buckets, … }. Keeps nothing of the zoom. */
    show(axis) {
      this.axis = axis;
      this.busy = true;
      for (const chart of this.list) this.draw(chart);
      this.busy = false;
      this.clearCursor();
    }

    draw(chart) {
      const { spec } = chart;
      chart.series = spec.series(this.axis);
      chart.rows = rowsOf(this.axis, chart.series);
      if (chart.graph) chart.graph.destroy();
      chart.plot.textContent = "";
      this.makeLegend(chart);
      const top = spec.top ? spec.top(chart.series) : null;
      chart.graph = new Dygraph(chart.plot, chart.rows, {
        labels: ["position", ...chart.series.map((one, k) => `${k}`)],
        colors: chart.series.map((one) => colour(one.colour)),
        series: Object.fromEntries(
          chart.series.map((one, k) => [`${k}`, { strokeWidth: one.width, strokePattern: one.dash || null }])),
        dateWindow: [0, this.axis.length],
        valueRange: [0, top],
        includeZero: true,
        legend: "never",
        xlabel: this.axis.name,
        ylabel: spec.unit,
        xLabelHeight: 16,
        yLabelWidth: 16,
        axes: {
          x: { axisLabelFontSize: 12, pixelsPerLabel: 70, drawGrid: false },
          y: { axisLabelFontSize: 12, axisLabelWidth: 46, pixelsPerLabel: 34 },
        },
        axisLineColor: colour("line"),
        gridLineColor: colour("grid"),
        rightGap: 8,
        highlightCircleSize: 3.5,
        animatedZooms: false,
        interactionModel: interactionModel(() => this.reset()),
        underlayCallback: (context, area, graph) => {
          if (spec.underlay) clipTo(context, area, () => spec.underlay(context, area, graph, this.axis));
        },
        drawCallback: (graph) => this.follow(graph),
        highlightCallback: (event, x, points, row) => this.setCursor(row, chart),
        unhighlightCallback: () => this.clearCursor(),
      });
      chart.cursor = chart.plot.appendChild(element("div", "cursor"));
      chart.cursor.hidden = true;
    }

    makeLegend(chart) {
      chart.legend.textContent = "";
      chart.values = chart.series.map((one) => {
        const entry = chart.legend.appendChild(element("span", "entry"));
        entry.append(lineSample(one), element("span", "", one.label));
        return entry.appendChild(element("span", "value"));
      });
      chart.note = chart.legend.appendChild(element("span", "position"));
    }

    /** All charts show the range that one of them was zoomed or moved to. */
    follow(graph) {
      if (this.busy) return;
      this.busy = true;
      const range = graph.xAxisRange();
      for (const chart of this.list) {
        if (chart.graph && chart.graph !== graph) chart.graph.updateOptions({ dateWindow: range });
      }
      this.busy = false;
    }

    reset() {
      this.busy = true;
      for (const chart of this.list) {
        chart.graph.updateOptions({
          dateWindow: [0, this.axis.length],
          valueRange: [0, chart.spec.top ? chart.spec.top(chart.series) : null],
        });
      }
      this.busy = false;
    }

    resize() {
      this.busy = true;
      for (const chart of this.list) chart.graph.resize();
      this.busy = false;
    }

    rowAt(position) {
      const count = 2 * this.axis.buckets;
      return Math.min(count - 1, Math.max(0, Math.floor((position / this.axis.length) * count)));
    }

    /** Cursor on one row in all charts; `source` is the chart under the pointer, if any. */
    setCursor(row, source) {
      for (const chart of this.list) {
        const values = chart.rows[row];
        if (chart !== source) chart.graph.setSelection(row);
        const area = chart.graph.getArea();
        const x = chart.graph.toDomXCoord(values[0]);
        chart.cursor.hidden = x < area.x || x > area.x + area.w;
        chart.cursor.style.transform = `translateX(${x}px)`;
        chart.cursor.style.height = `${area.h}px`;
        chart.series.forEach((one, k) => {
          const value = values[k + 1];
          chart.values[k].textContent = value === null || value === undefined ? "–" : one.format(value);
        });
        const note = chart.spec.note ? chart.spec.note(row, this.axis) : "";
        chart.note.textContent = [note, `at ${this.axis.format(values[0])}`].filter(Boolean).join(", ");
      }
      if (source) this.onCursor(this.list[0].rows[row][0]);
    }

    clearCursor() {
      for (const chart of this.list) {
        if (chart.graph) chart.graph.clearSelection();
        chart.cursor.hidden = true;
        for (const value of chart.values) value.textContent = "";
        chart.note.textContent = "";
      }
      this.onCursor(null);
    }
  }

  /** Colours, width and paper are read while drawing; so a change of them draws again. */
  function followWindow(redraw) {
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
    let width = innerWidth;
    let waiting = 0;
    addEventListener("resize", () => {
      if (innerWidth === width) return;
      width = innerWidth;
      clearTimeout(waiting);
      waiting = setTimeout(redraw, 120);
    });
    const forPaper = (printing) => {
      document.documentElement.classList.toggle("printing", printing);
      redraw();
    };
    addEventListener("beforeprint", () => forPaper(true));
    addEventListener("afterprint", () => forPaper(false));
  }

  return { LinkedCharts, drawBand, drawStrip, element, colour, forgetColours, followWindow, interactionModel };
})();
