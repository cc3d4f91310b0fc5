// What a report can do beyond being read: values under the pointer, and zoom by selecting. Without it the page is whole.
"use strict";
const SVG = "http://www.w3.org/2000/svg";
const REACH = 9; // pixels from the pointer to a dot that is meant

// A point of an axis and its value as shown; `measured` is the logarithm on a logarithmic axis.
function axis(plot, name, from, to) {
  if (!plot.dataset[name]) return null;
  const [low, high, log] = plot.dataset[name].split(" ");
  return {
    low: +low, high: +high, from, to, log: log === "log",
    title: plot.dataset[name + "Title"], unit: plot.dataset[name + "Unit"],
    measured(pixel) { return this.low + (pixel - from) / (to - from) * (this.high - this.low); },
    value(pixel) { return this.log ? 10 ** this.measured(pixel) : this.measured(pixel); },
    pixel(measured) { return from + (measured - this.low) / (this.high - this.low) * (to - from); },
  };
}

// The points of a path, in runs that are not joined.
function runs(path) {
  const data = path.getAttribute("d");
  return data.split("M").slice(1).map((run) =>
    [...run.matchAll(/(-?\d*\.?\d+),(-?\d*\.?\d+)/g)].map((pair) => [+pair[1], +pair[2]]));
}

// Where a path is at a pixel of the x axis: none, one, or the two edges of a band.
function crossings(shape, at) {
  if (shape.kind === "dots") {
    const near = shape.runs.map((run) => run[0]).filter(([x]) => Math.abs(x - at) <= REACH);
    near.sort((a, b) => Math.abs(a[0] - at) - Math.abs(b[0] - at));
    return near.slice(0, 1).map(([, y]) => y);
  }
  const found = [];
  for (const run of shape.runs) {
    const points = shape.kind === "band" ? [...run, run[0]] : run;
    for (let i = 1; i < points.length; i++) {
      const [[x0, y0], [x1, y1]] = [points[i - 1], points[i]];
      if (x0 === x1 || (x0 - at) * (x1 - at) > 0) continue;
      found.push(y0 + (y1 - y0) * (at - x0) / (x1 - x0));
    }
  }
  if (!found.length) return [];
  return shape.kind === "band" ? [Math.max(...found), Math.min(...found)] : found.slice(0, 1);
}

function spelled(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(2) : size >= 100 ? value.toFixed(0) : value.toPrecision(3);
  return text.replaceAll("-", "\u2212");
}

class Plot {
  constructor(group) {
    this.group = group;
    this.svg = group.ownerSVGElement;
    [this.left, this.top, this.right, this.bottom] = group.dataset.area.split(" ").map(Number);
    this.x = axis(group, "x", this.left, this.right);
    this.y = axis(group, "y", this.bottom, this.top);
    this.key = [this.x.title, this.x.unit, group.dataset.x].join();
    this.shapes = [...group.querySelectorAll("[data-name]")].map((path) =>
      ({ path, kind: path.classList[0], name: path.dataset.name || (this.y && this.y.title), runs: runs(path) }));
    this.whole();
  }

  whole() { this.show(this.left, this.right); }

  // Shows what lies between two pixels of the whole.
  show(from, to) {
    this.from = from;
    this.scale = (this.right - this.left) / (to - from);
    this.zoomed = this.scale > 1.0001;
    this.svg.classList.toggle("zoomed", this.zoomed);
    [this.yScale, this.yShift] = this.zoomed ? this.fitted(from, to) : [1, 0];
    const across = `translate(${this.left - from * this.scale} 0) scale(${this.scale} 1)`;
    const up = `translate(0 ${this.yShift}) scale(1 ${this.yScale})`;
    for (const shape of this.group.querySelectorAll("path, rect")) {
      const kind = shape.classList[0];
      const both = ["line", "dots", "band"].includes(kind);
      shape.setAttribute("transform", !this.zoomed ? "" : kind === "guide" ? up : both ? `${across} ${up}` : across);
    }
    for (const shade of this.svg.querySelectorAll(".shade")) this.move(shade);
    this.ticks(".ticks-x", this.x, (at) => this.placed(at), 70, from, to);
    if (this.y) {
      const whole = (pixel) => (pixel - this.yShift) / this.yScale;
      this.ticks(".ticks-y", this.y, (at) => at * this.yScale + this.yShift, 40, whole(this.bottom), whole(this.top));
    }
  }

  placed(pixel) { return this.left + (pixel - this.from) * this.scale; }

  move(shade) {
    shade.dataset.span ||= [+shade.getAttribute("x"), +shade.getAttribute("width")].join(" ");
    const [x, width] = shade.dataset.span.split(" ").map(Number);
    const moment = shade.classList.contains("moment");
    const begin = Math.max(this.placed(x), this.left), end = Math.min(moment ? this.placed(x) + width : this.placed(x + width), this.right);
    shade.setAttribute("x", begin);
    shade.setAttribute("width", Math.max(end - begin, 0));
  }

  // The scale and shift of y with which the lines between two pixels fill the frame.
  fitted(from, to) {
    let low = Infinity, high = -Infinity;
    for (const shape of this.shapes.filter((shape) => ["line", "dots"].includes(shape.kind))) {
      const edges = [from, to].flatMap((at) => crossings(shape, at));
      const inside = shape.runs.flat().filter(([x]) => x >= from && x <= to).map(([, y]) => y);
      for (const y of [...edges, ...inside]) [low, high] = [Math.min(low, y), Math.max(high, y)];
    }
    if (!this.y || !(high - low > 2)) return [1, 0];
    const scale = (this.bottom - this.top) * 0.88 / (high - low);
    return [scale, (this.top + this.bottom) / 2 - scale * (low + high) / 2];
  }

  ticks(selector, axis, place, apart, from, to) {
    const group = this.svg.querySelector(selector);
    group.original ||= [...group.children];
    if (!this.zoomed) return group.replaceChildren(...group.original);
    const most = Math.abs(axis.to - axis.from) / apart;
    const [low, high] = [axis.measured(from), axis.measured(to)];
    const step = [1, 2, 5, 10].map((m) => m * 10 ** Math.floor(Math.log10((high - low) / most)))
      .find((step) => step >= (high - low) / most * 0.999);
    const made = [];
    const add = (name, attributes, text) => {
      const element = document.createElementNS(SVG, name);
      Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
      element.textContent = text;
      made.push(element);
    };
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    for (let n = Math.ceil(low / step - 1e-6); n * step <= high + step * 1e-6; n++) {
      const at = place(axis.pixel(n * step));
      const label = axis.log ? spelled(10 ** (n * step)) : (n * step).toFixed(decimals).replace("-", "\u2212");
      if (axis === this.x) {
        add("path", { class: "grid", d: `M${at},${this.top}V${this.bottom}` }, "");
        add("text", { class: "tick", x: at, y: this.bottom + 16, "text-anchor": "middle" }, label);
      } else {
        add("path", { class: "grid", d: `M${this.left},${at}H${this.right}` }, "");
        add("text", { class: "tick", x: this.left - 6, y: at + 4, "text-anchor": "end" }, label);
      }
    }
    group.replaceChildren(...made);
  }

  // The pixel of the whole under a pointer; null outside the frame.
  under(event) {
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
    if (point.x < this.left || point.x > this.right || point.y < this.top || point.y > this.bottom) return null;
    return this.from + (point.x - this.left) / this.scale;
  }

  // What is drawn at a pixel of the whole: name, value, colour.
  told(at) {
    return this.shapes.flatMap((shape) => {
      const [y, other] = crossings(shape, at);
      if (shape.kind === "fill") {
        const row = shape.runs.some(([[x]], i) => at >= x && at <= x + +shape.path.getAttribute("d").split("M")[i + 1].match(/h([\d.]+)/)[1]);
        return row ? [[shape.name, "", shape.path]] : [];
      }
      if (y === undefined) return [];
      const values = [y, other].filter((y) => y !== undefined).map((y) => spelled(this.y.value(y)));
      return [[shape.name, `${values.join(" … ")} ${this.y.unit}`, shape.path]];
    });
  }
}

const plots = [...document.querySelectorAll("g.plot")].map((group) => new Plot(group));
const alike = (plot) => plots.filter((other) => other.key === plot.key);
const readout = document.body.appendChild(document.createElement("div"));
readout.id = "readout";
readout.hidden = true;

// The span of the whole between two pixels, as shares of it, so that drawings of every width show the same.
function zoom(plot, from, to) {
  const share = (pixel) => (pixel - plot.left) / (plot.right - plot.left);
  for (const other of alike(plot)) {
    const pixel = (at) => other.left + share(at) * (other.right - other.left);
    other.show(pixel(from), pixel(to));
  }
}

function rule(plot, at, name) {
  const line = plot.svg.querySelector(`.${name}`) || plot.svg.appendChild(document.createElementNS(SVG, "path"));
  line.setAttribute("class", name);
  line.setAttribute("d", at === null ? "" : `M${plot.placed(at)},${plot.top}V${plot.bottom}`);
}

function tell(plot, event) {
  const at = plot.under(event);
  for (const other of alike(plot).filter((other) => other.svg.clientWidth || other.svg.getBoundingClientRect().width)) {
    const there = at === null ? null : other.left + (at - plot.left) / (plot.right - plot.left) * (other.right - other.left);
    rule(other, there, "rule");
  }
  const told = at === null ? [] : plot.told(at);
  readout.hidden = told.length === 0;
  if (!told.length) return;
  const head = document.createElement("b");
  head.textContent = `${plot.x.title} ${spelled(plot.x.value(at))} ${plot.x.unit}`;
  readout.replaceChildren(head, ...told.map(([name, value, path]) => {
    const line = document.createElement("div");
    line.append(document.createElement("i"), `${name} ${value}`);
    line.firstChild.style.background = getComputedStyle(path).getPropertyValue("--tone");
    return line;
  }));
  const { width, height } = readout.getBoundingClientRect();
  readout.style.left = `${Math.max(4, Math.min(event.clientX + 16, innerWidth - width - 8))}px`;
  readout.style.top = `${Math.max(4, Math.min(event.clientY + 16, innerHeight - height - 8))}px`;
}

for (const plot of plots) {
  let began = null;
  const select = (event) => {
    const at = plot.under(event);
    const box = plot.svg.querySelector(".selected") || plot.svg.appendChild(document.createElementNS(SVG, "path"));
    const wide = began !== null && at !== null;
    box.setAttribute("class", "selected");
    box.setAttribute("d", wide ? `M${plot.placed(began)},${plot.top}H${plot.placed(at)}V${plot.bottom}H${plot.placed(began)}Z` : "");
    return at;
  };
  plot.svg.addEventListener("pointerdown", (event) => { if (event.pointerType === "mouse") began = plot.under(event); });
  plot.svg.addEventListener("pointermove", (event) => { tell(plot, event); select(event); });
  plot.svg.addEventListener("pointerleave", (event) => { began = null; select(event); tell(plot, event); });
  plot.svg.addEventListener("pointerup", (event) => {
    const at = select(event), from = began;
    began = null;
    select(event);
    if (from !== null && at !== null && Math.abs(plot.placed(at) - plot.placed(from)) > 8) zoom(plot, Math.min(from, at), Math.max(from, at));
  });
  plot.svg.addEventListener("dblclick", () => zoom(plot, plot.left, plot.right));
}
addEventListener("keydown", (event) => { if (event.key === "Escape") plots.forEach((plot) => plot.whole()); });

// A map plays the ways of its vehicles; without a script it shows them where they are at the moment in its caption.
for (const map of document.querySelectorAll("svg.map")) {
  const cars = [...map.querySelectorAll(".car")].map((car) =>
    ({ car, from: +car.dataset.from, way: car.dataset.way.split(" ").map((point) => point.split(",").map(Number)) }));
  const [from, to, at, every] = map.dataset.span.split(" ").map(Number);
  const [silentFrom, silentTo] = (map.dataset.silent || "0 0").split(" ").map(Number);
  const bar = document.createElement("div");
  bar.className = "player";
  const [button, slider, clock] = ["button", "input", "span"].map((name) => bar.appendChild(document.createElement(name)));
  Object.assign(slider, { type: "range", min: from, max: to, step: 0.05, value: at });
  slider.setAttribute("aria-label", "time");
  const draw = () => {
    const now = +slider.value;
    for (const { car, from, way } of cars) {
      const step = (now - from) / every, index = Math.floor(step), share = step - index;
      const [a, b] = [way[index], way[index + 1]];
      car.style.display = a && b ? "" : "none";
      if (a && b) ["cx", "cy"].forEach((key, k) => car.setAttribute(key, a[k] + (b[k] - a[k]) * share));
      if (car.classList.contains("ego")) car.classList.toggle("silent", now >= silentFrom && now < silentTo);
    }
    clock.textContent = `${now.toFixed(1)} s${now >= silentFrom && now < silentTo ? ", the ego is silent" : ""}`;
  };
  let last = null;
  const frame = (time) => {
    if (last === null) return;
    slider.value = +slider.value + (time - last) / 1000 * 4;
    last = time;
    draw();
    if (+slider.value < to - 0.06) requestAnimationFrame(frame); else stop();
  };
  const stop = () => { last = null; button.textContent = "Play (4 times as fast)"; };
  button.addEventListener("click", () => {
    if (last !== null) return stop();
    if (+slider.value >= to - 0.06) slider.value = from;
    button.textContent = "Stop";
    last = performance.now();
    requestAnimationFrame(frame);
  });
  slider.addEventListener("input", () => { stop(); draw(); });
  stop();
  map.after(bar);
  draw();
}
// The same command writes the same bytes, so that only the file itself knows when it was written.
document.querySelector("footer").append(` The file is of ${new Date(document.lastModified).toLocaleString()}.`);
document.documentElement.dataset.ready = "";
