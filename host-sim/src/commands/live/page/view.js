// The driver's view: the road and the other vehicles as plain solids in perspective.

import { roads } from "./roads.js";
import { colours, now } from "./scene.js";
import { stage } from "./stage.js";

const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);

export function ride(state) {
  const [canvas, rides] = [document.getElementById("view"), document.getElementById("rides")];
  const dash = document.getElementById("dash");
  let hue = colours();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => (hue = colours()));
  let solids = null;
  const ways = state.isRoad ? roads(state.cast) : null;

  rides.addEventListener("change", () => {
    canvas.hidden = dash.hidden = !rides.checked;
    if (rides.checked) solids ??= stage(canvas);
    if (rides.checked && !solids) {
      canvas.hidden = dash.hidden = true;
      rides.checked = false;
      rides.disabled = true;
      document.getElementById("said").textContent = "This browser has no WebGL, so there is no driver's view; the road from above stays.";
    }
  });

  function draw() {
    if (!rides.checked || !solids) return;
    const seen = now(state);
    const own = seen.find((one) => one.id === state.chosen);
    if (!own) return;
    const gap = own.gap_m == null ? "" : `, gap ${own.gap_m.toFixed(1)} m`;
    const pedals = own.is_driven ? `, you ask for ${own.command_mps2.toFixed(1)} m/s²` : "";
    dash.textContent = `${(own.speed_mps * 3.6).toFixed(0)} km/h, ${own.acceleration_mps2.toFixed(1).replace("-0.0", "0.0")} m/s²${gap}${pedals}`;
    solids.begin(rgb(hue.sky));
    if (state.isRoad) drawRoads(seen, own);
    else drawLane(seen, own);
    solids.show();
  }

  function drawLane(seen, own) {
    // All lengths are from the own front bumper, so that they stay small. Of the leader the view is from behind and above: ahead of it
    // is nobody.
    const behindM = state.chosen === 0 ? state.role(own.id).length_m + 9 : 2.1;
    const eye = state.chosen === 0 ? [-behindM, 0, 4] : [-behindM, 0.35, 1.45];
    solids.look(eye, state.chosen === 0 ? 0.16 : 0.03);
    solids.add([-100, 0, -0.3], [700, 400, 0.2], rgb(hue.grass));
    solids.add([-100, 0, -0.3], [700, 7.5, 0.29], rgb(hue.asphalt));
    const firstM = -(own.position_m % 12) - 24;
    for (let m = firstM; m < 250; m += 12) {
      for (const side of [-1.75, 1.75]) solids.add([m, side, -0.05], [4, 0.14, 0.07], rgb(hue.paint));
    }
    for (let m = -(own.position_m % 50) - 50; m < 250; m += 50) {
      for (const side of [-5.5, 5.5]) solids.add([m, side, 0], [0.15, 0.15, 1], rgb(hue.ink));
    }
    seen.forEach((one, index) => {
      if (index === state.chosen && index !== 0) return;
      const long = state.cast.vehicles[index].length_m;
      const tall = long > 8 ? 2.9 : long > 5.5 ? 2.2 : 0.85;
      const rear = one.position_m - own.position_m - long;
      const colour = rgb(one.is_driven ? hue.paper : index === state.chosen ? hue.chosen : hue.vehicle);
      solids.add([rear, 0, 0.25], [long, 1.8, tall], colour);
      if (tall < 1) solids.add([rear + long * 0.15, 0, 0.25 + tall], [long * 0.5, 1.6, 0.55], colour.map((c) => c * 0.7));
      for (const side of [-0.7, 0.7]) {
        const brakes = one.acceleration_mps2 < -0.7;
        solids.add([rear - 0.04, side, 0.7], [0.1, 0.3, 0.2], brakes ? [1, 0.15, 0.1] : [0.45, 0.08, 0.06]);
      }
    });
    // Where the own unit believes the vehicle ahead to be, and what is certain of its rear; and where other methods put it.
    const of = state.cast.vehicles[state.chosen - 1];
    if (!of) return;
    const at = (frontM) => frontM - own.position_m - of.length_m;
    for (const [frontM, colour] of others(own)) solids.add([at(frontM), 0, 0.2], [of.length_m, 1.95, 1.5], rgb(colour), 0.3);
    const target = document.getElementById("ghosts").checked ? own.target : null;
    if (!target) return;
    if (target.bound_m) {
      const [low, up] = target.bound_m;
      solids.add([at(low), 0, 0.02], [up - low, 3.2, 0.03], rgb(hue.ours), 0.55);
    }
    solids.add([at(target.position_m), 0, 0.2], [of.length_m, 1.95, 1.5], rgb(hue.ours), 0.3);
  }
  // Where the methods beside put the vehicle ahead, as far as they are to be shown.
  function others(own) {
    const all = [["newests", own.newest_m, hue.newest], ["papers", own.paper_m, hue.paper]];
    return all.filter(([id, frontM]) => frontM != null && document.getElementById(id).checked).map(([, ...rest]) => rest);
  }
  // A body with its brake lights, in the frame of its own rear: turned by an angle.
  function body([x, y], long, one, angle) {
    const tall = long > 8 ? 2.9 : long > 5.5 ? 2.2 : 0.85;
    const colour = rgb(one.is_driven ? hue.paper : hue.vehicle);
    const at = (along, left, up) => [x + along * Math.cos(angle) - left * Math.sin(angle), y + along * Math.sin(angle) + left * Math.cos(angle), up];
    solids.add(at(0, 0, 0.25), [long, 1.8, tall], colour, 1, angle);
    if (tall < 1) solids.add(at(long * 0.15, 0, 0.25 + tall), [long * 0.5, 1.6, 0.55], colour.map((c) => c * 0.7), 1, angle);
    for (const side of [-0.7, 0.7]) {
      const brakes = one.acceleration_mps2 < -0.7;
      solids.add(at(-0.04, side, 0.7), [0.1, 0.3, 0.2], brakes ? [1, 0.15, 0.1] : [0.45, 0.08, 0.06], 1, angle);
    }
  }

  // Roads that cross. All lengths are from the own front bumper: along the own way, and to its left.
  function drawRoads(seen, own) {
    const [e, n, heading] = ways.at(own.road, own.position_m);
    const [sin, cos] = [Math.sin(heading), Math.cos(heading)];
    const from = (east, north) => [(east - e) * sin + (north - n) * cos, (north - n) * sin - (east - e) * cos];
    const near = ([x, y]) => Math.hypot(x, y) < 330;
    solids.look([-2.1, 0.35, 1.45], 0.03);
    solids.add([-100, 0, -0.5], [700, 700, 0.2], rgb(hue.grass));
    ways.pieces.forEach((pieces, road) => {
      for (const piece of pieces) {
        const [x, y] = from(piece.e, piece.n);
        const angle = heading - Math.atan2(...piece.along);
        const long = piece.toM - piece.fromM;
        // Roads that cross do not lie at the same height, so that neither shimmers through the other.
        const up = -0.3 + 0.004 * road;
        solids.add([x, y, up], [long, 3.5, 0.25], rgb(hue.asphalt), 1, angle);
        for (const side of [-1.7, 1.7]) {
          const at = [x - side * Math.sin(angle), y + side * Math.cos(angle)];
          solids.add([...at, up], [long, 0.12, 0.26], rgb(hue.paint), 1, angle);
        }
      }
    });
    // Where the ways cross: the areas that no two vehicles share, and a post at each corner of the crossing.
    state.cast.intersections.forEach((square, index) => {
      const middle = from(...ways.middles[index]);
      if (!near(middle)) return;
      for (const [road, atM] of square.legs) {
        const [east, north, way] = ways.at(road, atM - square.half_m);
        solids.add([...from(east, north), -0.03 + 0.001 * road], [2 * square.half_m, 3.5, 0.02], rgb(hue.asphalt).map((c) => c * 0.8), 1, heading - way);
      }
      const street = ways.at(square.legs[0][0], square.legs[0][1])[2];
      for (const corner of [1, 3, 5, 7]) {
        const angle = street + (corner * Math.PI) / 4;
        const [x, y] = from(ways.middles[index][0] + 10 * Math.sin(angle), ways.middles[index][1] + 10 * Math.cos(angle));
        solids.add([x, y, 0], [0.25, 0.25, 3.5], rgb(hue.ink));
      }
    });
    for (const one of seen) {
      if (one.id === own.id) continue;
      const long = state.role(one.id).length_m;
      const [east, north, way] = ways.at(one.road, one.position_m - long);
      const at = from(east, north);
      if (near(at)) body(at, long, one, heading - way);
    }
    const target = document.getElementById("ghosts").checked ? own.target : null;
    const of = seen.find((one) => one.id === own.follows);
    if (!of) return;
    const long = state.role(of.id).length_m;
    const on = (wayM, up, size, alpha, colour = hue.ours) => {
      const [east, north, way] = ways.at(of.road, wayM);
      solids.add([...from(east, north), up], size, rgb(colour), alpha, heading - way);
    };
    for (const [frontM, colour] of others(own)) on(frontM - long, 0.2, [long, 1.95, 1.5], 0.3, colour);
    if (target?.of !== of.id) return;
    if (target.bound_m) on(target.bound_m[0] - long, 0.02, [target.bound_m[1] - target.bound_m[0], 3.2, 0.03], 0.55);
    on(target.position_m - long, 0.2, [long, 1.95, 1.5], 0.3);
  }

  return { draw };
}
