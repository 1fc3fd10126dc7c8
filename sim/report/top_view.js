// SPDX-License-Identifier: Apache-2.0
"use strict";

/** The part from above: the tool centre's path, coloured by tooth force over its limit. */
const topViews = (() => {
  const { element, colour } = charts;
  const shareClasses = 25;
  const margin = { left: 44, right: 10, top: 8, bottom: 34 };

  /** Undoes the differences of the embedded columns; lengths in mm, time in s. */
  function decodedPath(path) {
    const sums = (differences, unit) => {
      let sum = 0;
      return differences.map((difference) => (sum += difference) * unit);
    };
    return {
      time: sums(path.t, 1e-3), path: sums(path.s, 1e-2), x: sums(path.x, 1e-2), y: sums(path.y, 1e-2),
      z: sums(path.z, 1e-2), share: sums(path.share, 1e-3),
    };
  }

  const cuts = (run, i) => run.share[i] > 0.002;

  /** Heights at which a fair part of the cutting happens, highest first: the levels of a pocket, not its ramps. */
  function levelsOf(run) {
    const lengths = new Map();
    let total = 0;
    for (let i = 1; i < run.z.length; ++i) {
      if (!cuts(run, i)) continue;
      const length = Math.hypot(run.x[i] - run.x[i - 1], run.y[i] - run.y[i - 1]);
      const key = Math.round(run.z[i] * 20) / 20;
      lengths.set(key, (lengths.get(key) || 0) + length);
      total += length;
    }
    const levels = [...lengths].filter(([, length]) => length > 0.04 * total).map(([z]) => z).sort((a, b) => b - a);
    return levels.length > 12 ? [] : levels;
  }

  /** A ramp belongs to the level that it leads down to. */
  function levelIndex(levels, z) {
    const found = levels.findIndex((level) => level <= z + 0.03);
    return found < 0 ? levels.length - 1 : found;
  }

  function rampColours() {
    const stops = [0, 0.4, 0.75, 1];
    const rgb = [0, 1, 2, 3].map((k) => {
      const hex = colour(`force-${k}`);
      return [1, 3, 5].map((start) => parseInt(hex.slice(start, start + 2), 16));
    });
    return Array.from({ length: shareClasses }, (_, k) => {
      const share = (k + 0.5) / shareClasses;
      const upper = stops.findIndex((stop) => stop >= share);
      const part = (share - stops[upper - 1]) / (stops[upper] - stops[upper - 1]);
      const mixed = rgb[upper].map((value, c) => Math.round(rgb[upper - 1][c] + part * (value - rgb[upper - 1][c])));
      return `rgb(${mixed.join(",")})`;
    });
  }

  function niceStep(range, count) {
    const raw = range / count;
    const power = 10 ** Math.floor(Math.log10(raw));
    return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= raw);
  }

  const shortNumber = (value) => `${+value.toPrecision(6)}`.replace("-", "−");

  class TopView {
    constructor(host, scenario, onPoint) {
      this.scenario = scenario;
      this.onPoint = onPoint;
      const figure = host.appendChild(element("figure"));
      this.caption = figure.appendChild(element("figcaption"));
      this.drawing = figure.appendChild(element("div", "drawing"));
      this.canvas = this.drawing.appendChild(element("canvas"));
      this.canvas.setAttribute("role", "img");
      this.marks = this.drawing.appendChild(element("canvas", "marks"));
      this.tip = this.drawing.appendChild(element("div", "tip"));
      this.tip.hidden = true;
      this.marks.addEventListener("pointermove", (event) => this.pointAt(event));
      this.marks.addEventListener("pointerleave", () => this.onPoint(null));
    }

    /** run: decoded path; level: index into levels, or −1 for all with the deepest on top. */
    show(run, name, levels, level) {
      this.run = run;
      this.levels = levels;
      this.level = level;
      this.caption.textContent = name;
      const worst = run.share.reduce((a, b) => Math.max(a, b), 0);
      const peak = `peak ${(100 * worst).toFixed(0)} % of the limit`;
      this.caption.append(" ", element("small", "", peak));
      this.canvas.setAttribute("aria-label", `Path of ${name} from above, ${peak}`);
      this.draw();
    }

    visible(i) {
      return this.level < 0 || this.levels.length < 2 || levelIndex(this.levels, this.run.z[i]) === this.level;
    }

    /** Stock and cutting path, with room for the cutter. Approach moves may leave the picture. */
    extent() {
      const [minX, minY, maxX, maxY] = this.scenario.stock_mm;
      const box = { minX, minY, maxX, maxY };
      const { run } = this;
      for (let i = 0; i < run.x.length; ++i) {
        if (!cuts(run, i)) continue;
        box.minX = Math.min(box.minX, run.x[i]);
        box.maxX = Math.max(box.maxX, run.x[i]);
        box.minY = Math.min(box.minY, run.y[i]);
        box.maxY = Math.max(box.maxY, run.y[i]);
      }
      const room = 0.02 * Math.max(box.maxX - box.minX, box.maxY - box.minY, 1e-6);
      return { minX: box.minX - room, minY: box.minY - room, maxX: box.maxX + room, maxY: box.maxY + room };
    }

    layOut() {
      const box = this.extent();
      const width = this.drawing.clientWidth;
      const plotWidth = width - margin.left - margin.right;
      const aspect = (box.maxY - box.minY) / (box.maxX - box.minX);
      const plotHeight = Math.min(Math.max(plotWidth * aspect, 90), 560);
      const scale = Math.min(plotWidth / (box.maxX - box.minX), plotHeight / (box.maxY - box.minY));
      const drawnWidth = scale * (box.maxX - box.minX);
      const left = margin.left + Math.max(0, (plotWidth - drawnWidth) / 2);
      const top = margin.top + Math.max(0, (plotHeight - scale * (box.maxY - box.minY)) / 2);
      this.box = box;
      this.scale = scale;
      this.toX = (x) => left + scale * (x - box.minX);
      this.toY = (y) => top + scale * (box.maxY - y);
      const height = plotHeight + margin.top + margin.bottom;
      this.size = { width, height };
      return [this.canvas, this.marks].map((canvas) => {
        const ratio = window.devicePixelRatio || 1;
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
        canvas.style.height = `${height}px`;
        const context = canvas.getContext("2d");
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        return context;
      });
    }

    draw() {
      const [context, marks] = this.layOut();
      this.marksContext = marks;
      context.clearRect(0, 0, this.size.width, this.size.height);
      this.drawStock(context);
      this.drawAxes(context);
      context.save();
      context.beginPath();
      context.rect(this.toX(this.box.minX), this.toY(this.box.maxY), this.scale * (this.box.maxX - this.box.minX),
                   this.scale * (this.box.maxY - this.box.minY));
      context.clip();
      this.drawPath(context);
      context.restore();
      this.mark(null);
    }

    drawStock(context) {
      const [minX, minY, maxX, maxY] = this.scenario.stock_mm;
      const rectangle = [this.toX(minX), this.toY(maxY), this.scale * (maxX - minX), this.scale * (maxY - minY)];
      context.fillStyle = colour("stock");
      context.fillRect(...rectangle);
      context.save();
      context.beginPath();
      context.rect(...rectangle);
      context.clip();
      context.lineCap = context.lineJoin = "round";
      context.strokeStyle = colour("swept");
      context.lineWidth = this.scale * this.scenario.cutter_diameter_mm;
      context.beginPath();
      this.eachSegment((i) => cuts(this.run, i), context);
      context.stroke();
      context.restore();
      context.strokeStyle = colour("muted");
      context.lineWidth = 1;
      context.strokeRect(...rectangle);
    }

    /** Adds the segments that end in the chosen points to the context's path. */
    eachSegment(chosen, context) {
      const { run } = this;
      let connected = false;
      for (let i = 1; i < run.x.length; ++i) {
        if (!chosen(i) || !this.visible(i)) {
          connected = false;
          continue;
        }
        if (!connected) context.moveTo(this.toX(run.x[i - 1]), this.toY(run.y[i - 1]));
        context.lineTo(this.toX(run.x[i]), this.toY(run.y[i]));
        connected = true;
      }
    }

    drawPath(context) {
      const { run } = this;
      const thin = this.size.width < 420 ? 1.8 : 2.6;
      context.lineCap = context.lineJoin = "round";
      this.strokeWhere(context, (i) => run.share[i] < 0, colour("rapid"), 1, [2, 4]);
      this.strokeWhere(context, (i) => run.share[i] >= 0 && !cuts(run, i), colour("rapid"), 1, []);
      const order = this.levels.length > 1 && this.level < 0 ? this.levels.map((_, k) => k) : [null];
      const ramp = rampColours();
      for (const level of order) this.strokeLevel(context, level, ramp, thin);
      // What is over the limit comes last and on a halo: no deeper level hides it.
      const over = (i) => run.share[i] > 1;
      this.strokeWhere(context, over, colour("swept"), thin + 5, []);
      this.strokeWhere(context, over, colour("force-over"), thin + 2, []);
    }

    strokeWhere(context, chosen, style, width, dash) {
      context.strokeStyle = style;
      context.lineWidth = width;
      context.setLineDash(dash);
      context.beginPath();
      this.eachSegment(chosen, context);
      context.stroke();
      context.setLineDash([]);
    }

    /** Neighbours of the same colour make one stroke; level null is all of them. */
    strokeLevel(context, level, ramp, width) {
      const { run } = this;
      const classOf = (i) => {
        if (!cuts(run, i) || !this.visible(i)) return -1;
        if (level !== null && levelIndex(this.levels, run.z[i]) !== level) return -1;
        return Math.min(shareClasses - 1, Math.floor(run.share[i] * shareClasses));
      };
      context.lineWidth = width;
      for (let i = 1; i < run.x.length; ) {
        const current = classOf(i);
        context.beginPath();
        context.moveTo(this.toX(run.x[i - 1]), this.toY(run.y[i - 1]));
        for (; i < run.x.length && classOf(i) === current; ++i) context.lineTo(this.toX(run.x[i]), this.toY(run.y[i]));
        if (current < 0) continue;
        context.strokeStyle = ramp[current];
        context.stroke();
      }
    }

    drawAxes(context) {
      const { box } = this;
      const step = niceStep(box.maxX - box.minX, this.size.width < 420 ? 6 : 9);
      context.font = "12px system-ui, 'Liberation Sans', Arial, sans-serif";
      context.fillStyle = colour("muted");
      context.strokeStyle = colour("muted");
      context.lineWidth = 1;
      const bottom = this.toY(box.minY);
      const left = this.toX(box.minX);
      context.textBaseline = "top";
      context.textAlign = "center";
      for (let x = Math.ceil(box.minX / step) * step; x <= box.maxX; x += step) {
        this.tick(context, [this.toX(x), bottom], [this.toX(x), bottom + 5]);
        context.fillText(shortNumber(x), this.toX(x), bottom + 8);
      }
      context.textBaseline = "middle";
      context.textAlign = "right";
      for (let y = Math.ceil(box.minY / step) * step; y <= box.maxY; y += step) {
        this.tick(context, [left - 5, this.toY(y)], [left, this.toY(y)]);
        context.fillText(shortNumber(y), left - 8, this.toY(y));
      }
      context.textBaseline = "alphabetic";
      context.textAlign = "left";
      context.fillText("mm", left - 42, bottom + 18);
    }

    tick(context, from, to) {
      context.beginPath();
      context.moveTo(...from);
      context.lineTo(...to);
      context.stroke();
    }

    /** Index of the point that belongs to a position on the charts' axis, −1 outside. */
    indexAt(column, position) {
      const values = this.run[column];
      if (position === null || !values.length || position > values[values.length - 1]) return -1;
      let low = 0;
      let high = values.length - 1;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (values[middle] < position) low = middle + 1;
        else high = middle;
      }
      return low;
    }

    mark(index) {
      const context = this.marksContext;
      context.clearRect(0, 0, this.size.width, this.size.height);
      this.tip.hidden = true;
      if (index === null || index < 0) return;
      const { run } = this;
      const x = this.toX(run.x[index]);
      const y = this.toY(run.y[index]);
      const radius = Math.max(3, (this.scale * this.scenario.cutter_diameter_mm) / 2);
      context.strokeStyle = colour("text");
      context.lineWidth = 1.5;
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.stroke();
      context.fillStyle = colour("text");
      context.beginPath();
      context.arc(x, y, 2.5, 0, 2 * Math.PI);
      context.fill();
      const force = run.share[index] < 0 ? "rapid move" : `${(100 * run.share[index]).toFixed(0)} % of the limit`;
      this.tip.textContent = `${run.time[index].toFixed(2)} s, z ${shortNumber(run.z[index])} mm: ${force}`;
      this.tip.hidden = false;
      const room = this.size.width - this.tip.offsetWidth;
      this.tip.style.left = `${Math.max(0, Math.min(room, x + radius + 6))}px`;
      this.tip.style.top = `${Math.max(0, y - radius - 30)}px`;
    }

    pointAt(event) {
      const frame = this.marks.getBoundingClientRect();
      const { run } = this;
      let best = -1;
      let bestDistance = 18 ** 2;
      for (let i = 0; i < run.x.length; ++i) {
        if (run.share[i] < 0 || !this.visible(i)) continue;
        const distance = (this.toX(run.x[i]) - event.clientX + frame.left) ** 2 +
                         (this.toY(run.y[i]) - event.clientY + frame.top) ** 2;
        // Of two passes over one place the later, deeper one lies on top.
        if (distance <= bestDistance) {
          best = i;
          bestDistance = distance;
        }
      }
      this.onPoint(best < 0 ? null : { view: this, index: best });
    }
  }

  return { TopView, decodedPath, levelsOf };
})();
