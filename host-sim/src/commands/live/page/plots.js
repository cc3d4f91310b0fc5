// The instruments: figures of the chosen vehicle over the last seconds.

import { colours, prepare } from "./scene.js";

const SPAN_S = 20;

const error = (place) => (seen, scene) => {
  const truth = scene.byId.get(seen.follows)?.position_m;
  if (truth == null) return null;
  return place === "ours" ? seen.target?.error_m : seen.paper_m == null ? null : seen.paper_m - truth;
};
const ahead = (of) => (seen, scene) => {
  const other = scene.byId.get(seen.follows);
  return other ? of(other) : null;
};

// Each line: a colour, a figure of a vehicle in a scene, and what it is called where a plot has several.
const PLOTS = [
  { name: "error of the position ahead", unit: "m", least: 0.2, about: 0,
    lines: [["paper", error("paper"), "literal"], ["ours", error("ours"), "estimate"]],
    band: (seen, scene) => {
      const truth = scene.byId.get(seen.target?.of)?.position_m;
      return seen.target?.bound_m && truth != null ? seen.target.bound_m.map((end) => end - truth) : null;
    } },
  { name: "gap", unit: "m", least: 2, lines: [["ours", (seen) => seen.gap_m]] },
  { name: "speed", unit: "m/s", least: 2,
    lines: [["newest", ahead((other) => other.speed_mps), "ahead"], ["ours", (seen) => seen.speed_mps, "own"]] },
  { name: "acceleration", unit: "m/s²", least: 1, about: 0,
    lines: [["paper", (seen) => seen.command_mps2, "demanded"], ["ours", (seen) => seen.acceleration_mps2, "own"]] },
  { name: "age of the newest message", unit: "s", least: 0.5, from: 0, lines: [["ours", (seen) => seen.target?.age_s]] },
  { name: "load of its bus", unit: "%", least: 10, from: 0, lines: [["ours", (seen) => seen.load * 100]] },
];
const MODES = ["standby", "cooperative", "holdover", "fallback", "fault"];

// The words of a caption, each in its colour.
function say(caption, words) {
  words.forEach(([colour, text], place) => {
    const word = caption.children[place] ?? caption.appendChild(document.createElement(place ? "b" : "span"));
    if (word.className !== colour) word.className = colour;
    if (word.textContent !== text) word.textContent = text;
  });
}

export function plots(state, onChoice) {
  let hue = colours();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => (hue = colours()));
  const past = [];
  const figures = [...PLOTS.map((plot) => plot.name), "mode of its unit"].map((name) => {
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${name}, over the last ${SPAN_S} seconds; the newest figures stand above it`);
    say(caption, [["", name]]);
    figure.append(caption, canvas);
    document.getElementById("plots").append(figure);
    return { caption, canvas };
  });
  let stale = true;
  onChoice(() => (stale = true));

  function drawOne(plot, { caption, canvas }) {
    const [paint, width, height] = prepare(canvas);
    const untilS = past.at(-1).at_s;
    const figure = (of) => (scene) => {
      const seen = scene.byId.get(state.chosen);
      return seen ? of(seen, scene) : null; // it was not there yet
    };
    const x = (atS) => width - ((untilS - atS) / SPAN_S) * width;
    const series = plot.lines.map(([colour, of]) => [colour, past.map(figure(of))]);
    const bands = plot.band ? past.map(figure(plot.band)) : [];
    const values = [...series.flatMap(([, line]) => line), ...bands.flat()].filter((value) => value != null);
    let [low, high] = values.length ? [Math.min(...values), Math.max(...values)] : [0, 1];
    if (plot.about != null) [low, high] = [Math.min(low, plot.about), Math.max(high, plot.about)];
    if (plot.from != null) low = plot.from;
    const short = plot.least - (high - low);
    if (short > 0) [low, high] = plot.from != null ? [low, high + short] : [low - short / 2, high + short / 2];
    const y = (value) => height - 6 - ((value - low) / (high - low)) * (height - 12);
    paint.strokeStyle = hue.line;
    paint.beginPath();
    paint.moveTo(0, y(plot.about ?? low));
    paint.lineTo(width, y(plot.about ?? low));
    paint.stroke();
    paint.fillStyle = hue.ours;
    paint.globalAlpha = 0.2;
    bands.forEach((band, place) => {
      if (!band || place === 0) return;
      const from = x(past[place - 1].at_s);
      paint.fillRect(from, y(band[1]), x(past[place].at_s) - from + 0.5, y(band[0]) - y(band[1]));
    });
    paint.globalAlpha = 1;
    for (const [colour, line] of series) {
      paint.strokeStyle = hue[colour];
      paint.lineWidth = 1.5;
      paint.beginPath();
      let isOn = false;
      line.forEach((value, place) => {
        if (value == null) return (isOn = false);
        paint[isOn ? "lineTo" : "moveTo"](x(past[place].at_s), y(value));
        isOn = true;
      });
      paint.stroke();
    }
    paint.lineWidth = 1;
    paint.fillStyle = hue.faint;
    paint.font = "10px system-ui";
    paint.fillText(Number(high.toPrecision(3)), 3, 11);
    paint.fillText(Number(low.toPrecision(3)), 3, height - 3);
    const words = plot.lines.map(([colour, , name], place) => {
      const newest = series[place][1].at(-1);
      const figure = newest == null ? "–" : newest.toFixed(2).replace(/^-(0\.00)$/, "$1");
      return [name ? colour : "", `${name ?? ""} ${figure}${place === plot.lines.length - 1 ? ` ${plot.unit}` : ""}`.trim()];
    });
    say(caption, [["", plot.name], ...words]);
  }

  function drawModes({ caption, canvas }) {
    const [paint, width, height] = prepare(canvas);
    const untilS = past.at(-1).at_s;
    const tints = [hue.newest, hue.chosen, hue.ours, hue.warn, hue.warn];
    const tall = height / MODES.length;
    past.forEach((scene, place) => {
      if (place === 0) return;
      const [from, to] = [past[place - 1].at_s, scene.at_s].map((atS) => width - ((untilS - atS) / SPAN_S) * width);
      const mode = MODES.indexOf(scene.byId.get(state.chosen)?.mode);
      if (mode < 0) return;
      paint.fillStyle = tints[mode];
      paint.fillRect(from, mode * tall + 2, to - from + 0.5, tall - 4);
    });
    paint.fillStyle = hue.ink;
    paint.font = "10px system-ui";
    MODES.forEach((mode, place) => {
      paint.fillStyle = hue.panel;
      paint.fillRect(1, place * tall + 1, paint.measureText(mode).width + 5, tall - 2);
      paint.fillStyle = hue.ink;
      paint.fillText(mode, 3, place * tall + tall / 2 + 3);
    });
    say(caption, [["", "mode of its unit"], ["", past.at(-1).byId.get(state.chosen)?.mode ?? "–"]]);
  }

  let drawnAt = 0;
  return {
    rewind(scene) {
      while (past.length && past.at(-1).at_s >= scene.at_s) past.pop();
    },
    take(scene) {
      if (past.length && past.at(-1).ticks === scene.ticks) past.pop();
      // A pixel is some 60 ms, and a scene of many vehicles is large.
      if (past.length > 1 && scene.at_s - past.at(-2).at_s < 0.05) past.pop();
      past.push(scene);
      while (past[0].at_s < scene.at_s - SPAN_S) past.shift();
      stale = true;
    },
    draw(atMs) {
      // A plot of 20 s need not be drawn more often than this.
      if (!stale || !past.length || atMs - drawnAt < 66) return;
      [drawnAt, stale] = [atMs, false];
      PLOTS.forEach((plot, place) => drawOne(plot, figures[place]));
      drawModes(figures.at(-1));
    },
  };
}
