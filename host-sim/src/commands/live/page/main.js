// The page: what the engine shows is drawn, and what a person does is ordered.

import { drive } from "./drive.js";
import { frames } from "./frames.js";
import { get, listen, order } from "./link.js";
import { plots } from "./plots.js";
import { road } from "./scene.js";
import { tour } from "./tour.js";
import { ride } from "./view.js";

const byId = (id) => document.getElementById(id);
const cast = await (await get("/cast")).json();

// What every part of the page looks at.
const state = {
  cast,
  chosen: cast.ego,
  scene: null, // the newest one
  scenes: [], // the last ones, for smooth motion
  shownS: 0, // the time that is drawn
};

byId("title").textContent = `live: ${cast.title}, seed ${cast.seed}`;

// Choosing a vehicle.
const rows = cast.vehicles.map((role, index) => {
  const row = byId("vehicles").insertRow();
  const head = document.createElement("th");
  head.scope = "row";
  const button = document.createElement("button");
  button.textContent = role.name;
  button.onclick = () => choose(index);
  head.append(button);
  row.append(head);
  for (let cell = 0; cell < 7; cell++) row.insertCell();
  return row;
});
const of = byId("of");
of.add(new Option("all vehicles", ""));
cast.vehicles.forEach((role, index) => of.add(new Option(`vehicle ${role.name}`, index)));

const listeners = [];
export function choose(index) {
  if (index < 0 || index >= rows.length) return;
  state.chosen = index;
  rows.forEach((row, other) => {
    row.classList.toggle("is-chosen", other === index);
    row.querySelector("button").setAttribute("aria-pressed", other === index);
  });
  document.querySelectorAll(".chosen").forEach((one) => (one.textContent = `vehicle ${cast.vehicles[index].name}`));
  byId("record").href = `/bus.log?vehicle=${index}`;
  listeners.forEach((tell) => tell());
}

// Time.
const toggle = () => order({ do: state.scene?.is_playing ? "pause" : "play" });
const back = () => order({ do: "back", seconds: 10 });
byId("play").onclick = toggle;
byId("step").onclick = () => order({ do: "step", ticks: 1 });
byId("back").onclick = back;
byId("restart").onclick = () => order({ do: "restart" });
byId("pace").onchange = (event) => order({ do: "pace", factor: Number(event.target.value) });

// The links.
const whom = () => (of.value === "" ? null : Number(of.value));
const sliders = { delay: "s", spread: "s", loss: "" };
const radio = cast.radio ?? [0, 0, 0];
Object.keys(sliders).forEach((id, place) => {
  byId(id).value = radio[place];
  byId(id).oninput = tellSliders;
  byId(id).onchange = () =>
    order({
      do: "links",
      vehicle: whom(),
      delay_mean_s: Number(byId("delay").value),
      delay_std_s: Number(byId("spread").value),
      loss: Number(byId("loss").value),
    });
});
function tellSliders() {
  byId("delay-said").textContent = `${Math.round(byId("delay").value * 1000)} ms`;
  byId("spread-said").textContent = `${Math.round(byId("spread").value * 1000)} ms`;
  byId("loss-said").textContent = `${Math.round(byId("loss").value * 100)} %`;
}
tellSliders();
const silence = () => order({ do: "outage", vehicle: whom(), seconds: Number(byId("seconds").value) });
byId("outage").onclick = silence;
byId("heal").onclick = () => order({ do: "outage", vehicle: whom(), seconds: 0 });

// The switches.
// What was switched here a moment ago stands until the engine shows it.
const switchedAt = {};
byId("envelope").checked = cast.has_envelope;
byId("range_sensor").checked = cast.vehicles.some((role) => role.has_sensor);
byId("range_sensor").disabled = !byId("range_sensor").checked;
for (const part of ["holdover", "envelope", "range_sensor"]) {
  byId(part).onchange = async (event) => {
    const on = event.target.checked;
    switchedAt[part] = performance.now();
    if (!(await order({ do: "switch", vehicle: whom(), part, on }))) event.target.checked = !on;
  };
}
// Somebody else may have switched, and time may have gone back.
function tellSwitches(scene) {
  const some = scene.vehicles.filter((_, index) => index > 0 && (whom() ?? index) === index);
  const is = { holdover: (seen) => !seen.is_plain, envelope: (seen) => seen.has_envelope, range_sensor: (seen) => seen.sees };
  if (!some.length) return;
  for (const [part, on] of Object.entries(is)) {
    if (!(performance.now() - switchedAt[part] < 1000)) byId(part).checked = some.some(on);
  }
}

// Keys. In a field of a form they are the field's.
addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
  if (event.target.tagName === "INPUT" && event.target.type !== "checkbox") return;
  const onButton = /^(BUTTON|A|SUMMARY|INPUT)$/.test(event.target.tagName);
  const keys = {
    ".": () => order({ do: "step", ticks: 1 }),
    b: back,
    r: () => order({ do: "restart" }),
    o: silence,
    "+": () => view.zoom(1.25),
    "-": () => view.zoom(0.8),
    ArrowLeft: () => view.pan(-0.1),
    ArrowRight: () => view.pan(0.1),
  };
  if (!onButton) keys[" "] = toggle;
  if (/^\d$/.test(event.key)) choose(Number(event.key));
  else if (keys[event.key]) keys[event.key]();
  else return;
  event.preventDefault();
});

const parts = [];
const view = road(state, choose);
parts.push(view, plots(state, (tell) => listeners.push(tell)), drive(state), frames(state), tour(state), ride(state));
choose(cast.ego);

function tell(scene) {
  byId("clock").textContent = `${scene.at_s.toFixed(2)} s`;
  byId("play").textContent = scene.is_playing ? "Pause" : "Play";
  byId("pace").value = scene.pace;
  tellSwitches(scene);
  const number = (value, digits) => (value == null ? "–" : value.toFixed(digits).replace(/^-(0\.?0*)$/, "$1"));
  scene.vehicles.forEach((seen, index) => {
    const target = seen.target;
    const width = target?.bound_m ? target.bound_m[1] - target.bound_m[0] : null;
    const mode = seen.is_driven ? "driven by you" : seen.is_plain ? "without estimate" : seen.mode;
    const cells = [
      number(seen.speed_mps, 1), number(seen.gap_m, 1), mode + (seen.is_limited ? ", limited" : ""),
      number(target?.error_m, 2), number(width, 2), number(target?.age_s, 1), index === 0 ? "–" : seen.is_silent ? "silent" : "on",
    ];
    cells.forEach((text, place) => {
      const cell = rows[index].cells[place + 1];
      if (cell.textContent !== text) cell.textContent = text;
      cell.classList.toggle("is-bad", text === "silent" || (place === 1 && seen.gap_m < 0));
    });
  });
}

let told = 0;
listen((scene) => {
  const before = state.scene;
  if (!before || scene.ticks < before.ticks) {
    state.scenes = [];
    state.shownS = scene.at_s;
    parts.forEach((part) => part.rewind?.(scene));
  }
  if (before && scene.ticks === before.ticks) state.scenes.pop();
  state.scene = scene;
  state.scenes.push(scene);
  if (state.scenes.length > 30) state.scenes.shift();
  parts.forEach((part) => part.take?.(scene));
  if (performance.now() - told > 150 || !scene.is_playing) {
    told = performance.now();
    tell(scene);
  }
});

// The display runs a little behind the newest scene, so that there is always one to move towards.
let last = performance.now();
let drawn = 0;
function draw(now) {
  requestAnimationFrame(draw);
  const passed = Math.min((now - last) / 1000, 0.1);
  last = now;
  const { scene } = state;
  if (!scene) return;
  const aim = scene.is_playing ? scene.at_s - 0.05 * scene.pace : scene.at_s;
  state.shownS += scene.is_playing ? passed * scene.pace : 0;
  state.shownS += (aim - state.shownS) * (Math.abs(aim - state.shownS) > 0.3 ? 1 : 0.1);
  parts.forEach((part) => part.draw?.(now));
  drawn += 1;
}
requestAnimationFrame(draw);
// For those who measure, and for the tour.
globalThis.holdover = { state, choose, frames: () => drawn };
document.documentElement.dataset.ready = "yes";
