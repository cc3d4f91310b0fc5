// The frames on the bus of the chosen vehicle, decoded by the same DBC file that everybody gets.

import { get } from "./link.js";

// A DBC: for each identifier its name and its signals.
export function parse(text) {
  const messages = new Map();
  let message = null;
  for (const line of text.split("\n")) {
    const head = line.match(/^BO_ (\d+) (\w+):/);
    if (head) {
      message = { name: head[2], signals: [] };
      messages.set(Number(head[1]) % 2 ** 31, message);
      continue;
    }
    const signal = line.match(/^ SG_ (\w+) (M|m\d+M?)? ?: ?(\d+)\|(\d+)@([01])([+-]) \(([^,]+),([^)]+)\) \[[^\]]*\] "([^"]*)"/);
    if (!signal || !message) continue;
    const [, name, mux, start, length, order, sign, factor, offset, unit] = signal;
    message.signals.push({
      name, mux, unit, start: Number(start), length: Number(length), isIntel: order === "1", isSigned: sign === "-",
      factor: Number(factor), offset: Number(offset), words: new Map(),
    });
  }
  for (const [, id, name, list] of text.matchAll(/^VAL_ (\d+) (\w+) (.*);$/gm)) {
    const signal = messages.get(Number(id) % 2 ** 31)?.signals.find((one) => one.name === name);
    for (const [, value, word] of list.matchAll(/(-?\d+) "([^"]*)"/g)) signal?.words.set(Number(value), word);
  }
  return messages;
}

// The number in the bytes.
export function raw(signal, bytes) {
  let value = 0n;
  let bit = signal.start;
  for (let place = 0; place < signal.length; place++) {
    const one = BigInt(((bytes[bit >> 3] ?? 0) >> (bit & 7)) & 1);
    if (signal.isIntel) {
      value |= one << BigInt(place);
      bit += 1;
    } else {
      value = (value << 1n) | one;
      bit += bit % 8 === 0 ? 15 : -1; // the next byte's highest bit
    }
  }
  return Number(signal.isSigned ? BigInt.asIntN(signal.length, value) : value);
}

export function decode(message, bytes) {
  const switches = message.signals.find((signal) => signal.mux === "M");
  const chosen = switches ? `m${raw(switches, bytes)}` : null;
  return message.signals
    .filter((signal) => !signal.mux || signal === switches || signal.mux.replace("M", "") === chosen)
    .map((signal) => {
      const value = raw(signal, bytes);
      const number = Number((value * signal.factor + signal.offset).toPrecision(10));
      return `${signal.name} ${signal.words.get(value) ?? number}${signal.unit ? ` ${signal.unit}` : ""}`;
    });
}

export function frames(state) {
  const details = document.getElementById("frames");
  const table = document.getElementById("rows");
  let messages = null;
  let isBusy = false;

  async function show() {
    if (!details.open || isBusy) return;
    isBusy = true;
    try {
      messages ??= parse(await (await get("/holdover.dbc")).text());
      const rows = await (await get(`/frames?vehicle=${state.chosen}`)).json();
      while (table.rows.length > rows.length) table.deleteRow(-1);
      rows.forEach((row, place) => {
        const line = table.rows[place] ?? table.insertRow();
        const message = messages.get(row.id);
        const bytes = (row.data.match(/../g) ?? []).map((byte) => parseInt(byte, 16));
        const cells = [
          row.id.toString(16).toUpperCase(), message?.name ?? "?", row.cycle_s == null ? "–" : (row.cycle_s * 1000).toFixed(1),
          row.count, row.data, message ? decode(message, bytes).join(", ") : "",
        ];
        cells.forEach((text, at) => ((line.cells[at] ?? line.insertCell()).textContent = text));
      });
    } catch {
      // The next turn tries again; the link says when the simulation is gone.
    }
    isBusy = false;
  }
  setInterval(show, 250);
  details.addEventListener("toggle", show);
  return {};
}
