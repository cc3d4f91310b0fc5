// Driving: keys, pedals on the screen and a gamepad enter; what the pedals ask for is ordered whenever it changes.

import { announce, order } from "./link.js";
import { gamepads } from "./pad.js";

const byId = (id) => document.getElementById(id);
// Braking by a key, as a share of the hardest.
const KEY_BRAKES = 0.5;

export function drive(state) {
  const keys = new Set();
  let hard = false;
  let driven = null; // the vehicle that this page drives
  let toldDriven = null; // the vehicle of which it was told
  let asked = null; // what was asked for last
  let pad = 0;
  const readPads = gamepads(byId("pad"));

  // From -1, the hardest braking, to 1.
  function pedal() {
    if (keys.has("ArrowDown") || keys.has("brake")) return hard ? -1 : -KEY_BRAKES;
    if (keys.has("ArrowUp") || keys.has("gas")) return 1;
    return pad;
  }

  function spokenDriver() {
    if (driven === toldDriven) return "";
    toldDriven = driven;
    return driven === null ? "Its unit drives." : `You drive vehicle ${state.role(driven).name}.`;
  }

  function ask() {
    const at = pedal();
    if (driven === null) {
      if (at === 0) return;
      if (state.chosen === null) return; // the roads are empty
      driven = state.chosen;
      announce(spokenDriver);
    }
    const role = state.role(driven);
    const mps2 = Math.round((at >= 0 ? at * role.most_mps2 : at * role.braking_mps2) * 20) / 20;
    if (mps2 === asked) return;
    asked = mps2;
    const vehicle = driven;
    order({ do: "drive", vehicle, mps2 }).then((done) => {
      if (!done) forget();
    });
    byId("driving").textContent = `You drive vehicle ${role.name}: ${mps2} m/s².`;
    byId("release").disabled = false;
  }

  function forget() {
    if (driven !== null) announce(spokenDriver);
    [driven, asked] = [null, null];
    keys.clear();
    byId("driving").textContent = "Its unit drives.";
    byId("release").disabled = true;
  }

  async function release() {
    if (driven === null) return;
    const vehicle = driven;
    forget();
    await order({ do: "release", vehicle });
  }
  byId("release").onclick = release;

  const isField = (target) => target.tagName === "SELECT" || (target.tagName === "INPUT" && target.type !== "checkbox");
  addEventListener("keydown", (event) => {
    hard = event.shiftKey;
    if (isField(event.target)) return;
    if (event.key === "Shift" && keys.size) ask();
    if (event.key === "Enter" && driven !== null && event.target.tagName !== "BUTTON" && event.target.tagName !== "A") release();
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    event.preventDefault();
    keys.add(event.key);
    ask();
  });
  addEventListener("keyup", (event) => {
    hard = event.shiftKey;
    if (keys.delete(event.key) || driven !== null) ask();
  });
  // Who looks away drives no more, but the vehicle stays in his hands.
  addEventListener("blur", () => {
    keys.clear();
    if (driven !== null) ask();
  });
  for (const id of ["gas", "brake"]) {
    const button = byId(id);
    const press = (isDown) => {
      button.classList.toggle("is-down", isDown);
      isDown ? keys.add(id) : keys.delete(id);
      if (isDown || driven !== null) ask();
    };
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      press(true);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(end, () => press(false));
    button.addEventListener("keydown", (event) => {
      if (event.key === " " || event.key === "Enter") press(true);
    });
    button.addEventListener("keyup", (event) => {
      if (event.key === " " || event.key === "Enter") press(false);
    });
  }

  return {
    // A vehicle that someone else has taken, or let go, or a way back: the engine is right.
    take(scene) {
      if (driven !== null && asked !== null && !scene.byId.get(driven)?.is_driven && performance.now() - (this.since ?? 0) > 500) forget();
      if (driven === null) this.since = performance.now();
    },
    rewind() {
      forget();
    },
    draw() {
      const { at: next, isLetGo } = readPads();
      if (next !== pad) {
        pad = next;
        ask();
      }
      if (isLetGo) release();
    },
  };
}
