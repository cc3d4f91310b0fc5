// The page: what the engine shows is drawn, and what a person does is ordered.

import { drive } from "./drive.js";
import { frames } from "./frames.js";
import { announce, get, listen, order, say } from "./link.js";
import { map } from "./map.js";
import { plots } from "./plots.js";
import { road } from "./scene.js";
import { tour } from "./tour.js";
import { ride } from "./view.js";

const byId = (id) => document.getElementById(id);
const cast = await (await get("/cast")).json();

// What every part of the page looks at.
const state = {
  cast,
  isRoad: Boolean(cast.roads),
  chosen: cast.roads ? null : cast.ego,
  scene: null, // the newest one
  scenes: [], // the last ones, for smooth motion
  shownS: 0, // the time that is drawn
  hits: new Map(), // of a vehicle: with whom it collided last, and when
  // The collision of a vehicle, as long as it is shown.
  hit(id) {
    const hit = this.hits.get(id);
    return hit && this.scene.at_s - hit.atS < 5 ? hit : null;
  },
  // What stays the same of a vehicle.
  role(id) {
    if (!cast.roads) return cast.vehicles[id];
    const known = kinds.get(id) ?? "car";
    return { ...cast.kinds[known], name: `${id} (${known})` };
  },
};
const kinds = new Map(); // of the vehicles that are there

byId("title").textContent = `live: ${cast.title}, seed ${cast.seed}`;
document.body.classList.toggle("is-road", state.isRoad);
if (state.isRoad) {
  byId("roster-said").textContent = "The vehicles on the roads. Choose one with its button, with n and p, or on the map.";
  byId("lane").setAttribute("aria-label", "the virtual lane of an intersection: all legs by the distance to the crossing point");
  byId("follows").checked = false;
}

// Beside a device time is the device's.
const hasDevice = cast.device != null;
if (hasDevice) {
  for (const id of ["play", "step", "back", "restart", "pace"]) byId(id).disabled = true;
  byId("title").textContent += `, with a device as vehicle ${cast.vehicles[cast.device].name}`;
  byId("save").hidden = true;
}

// Choosing a vehicle.
const rows = new Map();
function rowOf(id) {
  if (rows.has(id)) return rows.get(id);
  const row = byId("vehicles").insertRow();
  const head = document.createElement("th");
  head.scope = "row";
  const button = document.createElement("button");
  button.textContent = state.role(id).name;
  button.onclick = () => choose(id);
  head.append(button);
  row.append(head);
  for (let cell = 0; cell < 9; cell++) row.insertCell().classList.toggle("of-road", cell < 2);
  rows.set(id, row);
  return row;
}
const of = byId("of");
of.add(new Option("all vehicles", ""));
if (state.isRoad) of.add(new Option("the chosen vehicle", "chosen"));
else cast.vehicles.forEach((role, index) => of.add(new Option(`vehicle ${role.name}`, index)));

const listeners = [];
export function choose(id) {
  if (id !== null && !rows.has(id)) return;
  state.chosen = id;
  rows.forEach((row, other) => {
    row.classList.toggle("is-chosen", other === id);
    row.querySelector("button").setAttribute("aria-pressed", other === id);
  });
  const name = id === null ? "no vehicle yet" : `vehicle ${state.role(id).name}`;
  document.querySelectorAll(".chosen").forEach((one) => (one.textContent = name));
  byId("record").href = `/bus.log?vehicle=${id ?? 0}`;
  listeners.forEach((tell) => tell());
}
function chooseNext(by) {
  const ids = [...rows.keys()];
  if (ids.length) choose(ids[(ids.indexOf(state.chosen) + by + ids.length) % ids.length]);
}
// Vehicles come and go. Who looks on at one that goes looks on at the one behind it, or at any.
function attend(scene) {
  scene.byId = new Map(scene.vehicles.map((seen) => [seen.id, seen]));
  for (const seen of scene.vehicles) {
    if (state.isRoad) kinds.set(seen.id, seen.kind);
    else seen.follows = seen.id > 0 ? seen.id - 1 : null;
    rowOf(seen.id);
  }
  for (const [id, row] of rows) {
    if (scene.byId.has(id)) continue;
    row.remove();
    rows.delete(id);
    kinds.delete(id);
  }
  if (scene.byId.has(state.chosen)) return;
  const behind = scene.vehicles.find((seen) => seen.follows === state.chosen && state.chosen !== null);
  const next = behind ?? scene.vehicles.find((seen) => !seen.has_left) ?? scene.vehicles[0];
  if (next || state.chosen !== null) choose(next?.id ?? null);
}

// Collisions are said once, and shown for a while.
function note(scene) {
  for (const [id, hit] of state.hits) if (hit.atS > scene.at_s) state.hits.delete(id); // time has gone back
  for (const [a, b] of scene.hits) {
    if (state.hits.get(a)?.other !== b) say(`Vehicles ${state.role(a).name} and ${state.role(b).name} collided at ${scene.at_s.toFixed(1)} s.`);
    state.hits.set(a, { other: b, atS: scene.at_s });
    state.hits.set(b, { other: a, atS: scene.at_s });
  }
}

// Who hears the page is told what the chosen vehicle's unit and link do, and whether time goes on.
let toldOf = null;
let newest = null;
function tellChanges(scene) {
  const seen = scene.byId.get(state.chosen);
  newest = { id: state.chosen, isPlaying: scene.is_playing, atS: scene.at_s, isSilent: Boolean(seen?.is_silent), mode: seen?.mode };
  // Of another vehicle only what changes from now on is told, but whether time goes on is of no vehicle.
  if (toldOf === null || toldOf.id !== newest.id || !seen) toldOf = { ...newest, isPlaying: toldOf?.isPlaying ?? newest.isPlaying };
  if (changes()) announce(spokenChanges);
}
// What is otherwise than it was told last; empty if it has come back to that.
function changes() {
  const [was, is] = [toldOf, newest];
  const [sentences, what] = [[], []];
  if (was.isPlaying !== is.isPlaying) sentences.push(is.isPlaying ? "Time goes on." : `Time stands still at ${is.atS.toFixed(1)} s.`);
  if (was.isSilent !== is.isSilent) what.push(is.isSilent ? "the vehicle ahead is silent" : "the vehicle ahead is heard again");
  if (was.mode !== is.mode) what.push(is.mode);
  if (what.length) sentences.push(`Vehicle ${state.role(is.id).name}: ${what.join(", ")}.`);
  return sentences.join(" ");
}
function spokenChanges() {
  const what = changes();
  toldOf = newest;
  return what;
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
const whom = () => (of.value === "" ? null : of.value === "chosen" ? state.chosen : Number(of.value));
const sliders = { delay: "s", spread: "s", loss: "" };
const radio = cast.radio ?? [0, 0, 0];
let movedAt = -Infinity;
Object.keys(sliders).forEach((id, place) => {
  byId(id).value = radio[place];
  byId(id).oninput = () => {
    movedAt = performance.now();
    tellSliders();
  };
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
  const ms = (id) => `${Math.round(byId(id).value * 1000)} ms`;
  const texts = { delay: ms("delay"), spread: ms("spread"), loss: `${Math.round(byId("loss").value * 100)} %` };
  for (const [id, text] of Object.entries(texts)) {
    byId(`${id}-said`).textContent = text;
    byId(id).setAttribute("aria-valuetext", text);
  }
}
tellSliders();
// What was changed last that is about the vehicle, or about all. A slider that was moved a moment ago stands.
function showSliders(scene) {
  if (performance.now() - movedAt < 1000) return;
  const is = scene.links.findLast(([vehicle]) => vehicle === null || vehicle === whom())?.[1] ?? radio;
  Object.keys(sliders).forEach((id, place) => (byId(id).value = is[place]));
  tellSliders();
}
const silence = () => order({ do: "outage", vehicle: whom(), seconds: Number(byId("seconds").value) });
byId("outage").onclick = silence;
byId("heal").onclick = () => order({ do: "outage", vehicle: whom(), seconds: 0 });

// The switches.
// What was switched here a moment ago stands until the engine shows it.
const switchedAt = {};
byId("envelope").checked = cast.has_envelope;
byId("range_sensor").checked = (state.isRoad ? Object.values(cast.kinds) : cast.vehicles).some((role) => role.has_sensor);
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
  const isOf = (seen) => (whom() == null ? seen.id !== cast.device : seen.id === whom());
  const some = scene.vehicles.filter((seen) => (state.isRoad || seen.id > 0) && isOf(seen));
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
    n: () => chooseNext(1),
    p: () => chooseNext(-1),
    r: () => order({ do: "restart" }),
    o: silence,
    "+": () => view.zoom(1.25),
    "-": () => view.zoom(0.8),
    ArrowLeft: () => view.pan(-0.1),
    ArrowRight: () => view.pan(0.1),
    PageUp: () => view.pan(0, 0.1),
    PageDown: () => view.pan(0, -0.1),
  };
  if (!onButton) keys[" "] = toggle;
  if (/^\d$/.test(event.key)) choose(state.isRoad ? [...rows.keys()][Number(event.key)] ?? state.chosen : Number(event.key));
  else if (keys[event.key]) keys[event.key]();
  else return;
  event.preventDefault();
});

const parts = [];
const view = state.isRoad ? map(state, choose) : road(state, choose);
parts.push(view, plots(state, (tell) => listeners.push(tell)), drive(state), frames(state), tour(state), ride(state));
if (!state.isRoad) cast.vehicles.forEach((_, index) => rowOf(index));
choose(state.chosen);

function tell(scene) {
  tellChanges(scene);
  byId("clock").textContent = `${scene.at_s.toFixed(2)} s`;
  byId("play").textContent = scene.is_playing ? "Pause" : "Play";
  byId("pace").value = scene.pace;
  tellSwitches(scene);
  showSliders(scene);
  const number = (value, digits) => (value == null ? "–" : value.toFixed(digits).replace(/^-(0\.?0*)$/, "$1"));
  scene.vehicles.forEach((seen) => {
    const target = seen.target;
    const width = target?.bound_m ? target.bound_m[1] - target.bound_m[0] : null;
    const hit = state.hit(seen.id);
    const mode = hit ? `collided with ${hit.other}` : seen.is_driven ? "driven by you" : seen.is_plain ? "without estimate" : seen.mode;
    const at = seen.next == null ? "" : ` at ${cast.intersections[seen.next].name}`;
    const cells = [
      state.isRoad ? cast.roads[seen.road].name : "", seen.has_left ? "left" : (seen.place ?? "–") + at,
      number(seen.speed_mps, 1), number(seen.gap_m, 1), mode + (seen.is_limited ? ", limited" : ""),
      number(target?.error_m, 2), number(width, 2), number(target?.age_s, 1), !state.isRoad && seen.id === 0 ? "–" : seen.is_silent ? "silent" : "on",
    ];
    cells.forEach((text, place) => {
      const cell = rows.get(seen.id).cells[place + 1];
      if (cell.textContent !== text) cell.textContent = text;
      cell.classList.toggle("is-bad", text === "silent" || (place === 4 && hit != null));
    });
  });
}

let told = 0;
let heard = 0;
listen((scene) => {
  heard += 1;
  attend(scene);
  note(scene);
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
globalThis.holdover = { state, choose, camera: view.camera, frames: () => drawn, heard: () => heard };
document.documentElement.dataset.ready = "yes";
