// SPDX-License-Identifier: Apache-2.0
"use strict";

/** All machines of a shop, by /shop.json once a second. What a machine's messages hold is text until it has been read. */
(() => {
  const periodMs = 1000;
  const oldStateS = 5;
  const mostNotes = 20;

  const isNumber = (value) => typeof value === "number" && Number.isFinite(value);
  const number = (value, digits, unit) => (isNumber(value) ? `${value.toFixed(digits)} ${unit}`.trim() : "no estimate");
  /** With its date where that is not today's. */
  function clock(unixS) {
    if (!isNumber(unixS)) return "–";
    const time = new Date(1000 * unixS);
    const isToday = time.toDateString() === new Date().toDateString();
    return isToday ? time.toTimeString().slice(0, 8) : time.toLocaleString();
  }

  /** An object, or null where the text is none. */
  function read(text) {
    try {
      const value = JSON.parse(text);
      return value !== null && typeof value === "object" && !Array.isArray(value) ? value : null;
    } catch {
      return null;
    }
  }

  /** In one word, and in a class. */
  function condition(machine, state, nowS) {
    if (!machine.is_online) return ["gone", "not connected"];
    if (!state || !isNumber(state.unix_s) || nowS - state.unix_s > oldStateS) return ["idle", "no run"];
    if (state.fault && state.fault !== "none") return ["alarm", `fault: ${inWords(state.fault)}`];
    if (state.hold === true) return ["alarm", "feed held"];
    if (state.state === "in_cut" || state.state === "entry") return ["cutting", "cuts"];
    return ["waiting", inWords(state.state ?? "no state")];
  }

  function bar(share) {
    const box = element("div", share > 1 ? "bar over" : "bar");
    const filled = element("span");
    filled.style.width = `${Math.min(100, Math.max(0, 100 * share))}%`;
    box.append(filled);
    return box;
  }

  function card(machine, nowS) {
    const state = read(machine.state);
    const [className, word] = condition(machine, state, nowS);
    const box = element("article", `machine ${className}`);
    box.append(element("h2", "", machine.name), element("span", "word", word));
    if (!state) return box;
    const load = state.peak_force_N / state.force_limit_N;
    if (className === "cutting" && isNumber(load)) box.append(bar(load));
    const facts = element("dl");
    const fact = (name, text) => facts.append(element("dt", "", name), element("dd", "", text));
    if (className === "cutting") fact("Load", isNumber(load) ? `${(100 * load).toFixed(0)} % of the limit` : "no estimate");
    fact("Override", number(100 * state.override, 0, "%"));
    if (className === "cutting") {
      fact("Held by", inWords(state.limit ?? "–"));
      fact("Immersion", number(state.radial_immersion, 2, "R"));
      fact("Depth", number(state.axial_depth_mm, 1, "mm"));
    }
    if (state.tool) fact("Tool", String(state.tool));
    fact("Seen", clock(state.unix_s));
    box.append(facts);
    return box;
  }

  /** Newest first, of all machines. */
  function notes(machines, kind, timeOf, textOf) {
    const all = machines.flatMap((machine) => machine[kind].map((text) => [machine.name, read(text)]));
    return all.filter(([, note]) => note).sort((a, b) => (timeOf(b[1]) ?? 0) - (timeOf(a[1]) ?? 0)).slice(0, mostNotes)
      .map(([name, note]) => {
        const line = element("li");
        line.append(element("time", "", clock(timeOf(note))), element("b", "", name), textOf(note));
        return line;
      });
  }

  function jobInWords(job) {
    const faults = Array.isArray(job.faults) && job.faults.length ? `, faults: ${job.faults.length}` : "";
    return `cut for ${number(job.cutting_s, 0, "s")}, largest load ${number(100 * job.largest_load, 0, "%")}, ` +
      `mean override ${number(100 * job.mean_override, 0, "%")}${faults}`;
  }

  function show(shop) {
    shop.machines.sort((a, b) => a.name.localeCompare(b.name, undefined, { numeric: true }));
    const cards = shop.machines.map((machine) => card(machine, shop.unix_s));
    const cutting = cards.filter((box) => box.classList.contains("cutting")).length;
    const online = shop.machines.filter((machine) => machine.is_online).length;
    byId("summary").textContent = shop.trouble
      ? `Broker ${shop.broker}: ${shop.trouble}. What is shown may be old.`
      : `${shop.machines.length} machines, ${online} connected, ${cutting} cutting.`;
    byId("machines").replaceChildren(...cards);
    byId("events").replaceChildren(...notes(shop.machines, "events", (note) => note.unix_s, (note) => inWords(note.text)));
    byId("jobs").replaceChildren(...notes(shop.machines, "jobs", (job) => job.end_unix_s, jobInWords));
    if (!byId("jobs").hasChildNodes()) byId("jobs").append(element("li", "", "None has ended since this page's program started."));
  }

  async function turn() {
    try {
      const answer = await fetch("shop.json", { signal: AbortSignal.timeout(5 * periodMs) });
      show(await answer.json());
    } catch {
      byId("summary").textContent = "millforce shop does not answer. What is shown is old.";
    }
    setTimeout(turn, periodMs);
  }
  turn();
})();
