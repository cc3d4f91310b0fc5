// A corridor from above: vehicles on their roads, and each as the one behind it believes it to be, with the bound as a band. Below it the
// virtual lane of an intersection: all of its legs on one axis, by the distance to the crossing point.

import { roads } from "./roads.js";
import { colours, cross, now, prepare } from "./scene.js";
import { touch } from "./touch.js";

const byId = (id) => document.getElementById(id);
const LANE_M = 3.5;
const WIDE = { car: 1.9, van: 2.1, bus: 2.5 };
// What the strip shows before and beyond the crossing point.
const [BEFORE_M, BEYOND_M] = [190, 25];

export function map(state, choose) {
  const canvas = byId("scene");
  const ways = roads(state.cast);
  const { middles } = ways;
  const camera = { e: 0, n: 0, perM: 1 };
  let hue = colours();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => (hue = colours()));
  let isPlaced = false;

  // All intersections at once.
  function overview(width, height) {
    const [es, ns] = [0, 1].map((axis) => middles.map((middle) => middle[axis]));
    const [east, west, north, south] = [Math.max(...es), Math.min(...es), Math.max(...ns), Math.min(...ns)];
    [camera.e, camera.n] = [(east + west) / 2, (north + south) / 2];
    camera.perM = Math.min(width / (east - west + 160), height / (north - south + 120), 8);
  }

  // What lies under a place stays there. Where the view follows a vehicle, that vehicle does.
  const zoom = (factor, x = canvas.clientWidth / 2, y = canvas.clientHeight / 2) => {
    const [right, down] = byId("follows").checked ? [0, 0] : [x - canvas.clientWidth / 2, y - canvas.clientHeight / 2];
    const before = camera.perM;
    camera.perM = Math.min(40, Math.max(0.2, camera.perM * factor));
    camera.e += right / before - right / camera.perM;
    camera.n -= down / before - down / camera.perM;
  };
  const move = (x, y) => {
    byId("follows").checked = false;
    camera.e += x / camera.perM;
    camera.n -= y / camera.perM;
  };
  const pan = (share, up = 0) => move(share * canvas.clientWidth, -up * canvas.clientHeight);
  byId("closer").onclick = () => zoom(1.25);
  byId("farther").onclick = () => zoom(0.8);
  touch(canvas, {
    zoom,
    move: (x, y) => (x !== 0 || y !== 0) && move(-x, -y),
    tap(x, y) {
      const e = camera.e + (x - canvas.clientWidth / 2) / camera.perM;
      const n = camera.n - (y - canvas.clientHeight / 2) / camera.perM;
      const far = (seen) => {
        const [east, north] = ways.at(seen.road, seen.position_m - state.role(seen.id).length_m / 2);
        return Math.hypot(east - e, north - n);
      };
      const [nearest] = [...now(state)].sort((a, b) => far(a) - far(b));
      if (nearest && far(nearest) < Math.max(8, 16 / camera.perM)) choose(nearest.id);
    },
  });

  function drawMap(vehicles) {
    const [paint, width, height] = prepare(canvas);
    if (!isPlaced) overview(width, height);
    isPlaced = true;
    const chosen = vehicles.find((one) => one.id === state.chosen);
    if (chosen && byId("follows").checked) {
      const [e, n] = ways.at(chosen.road, chosen.position_m);
      [camera.e, camera.n] = [e, n];
      if (camera.perM < 2.5) camera.perM = 4;
    }
    const [x, y] = [(e) => width / 2 + (e - camera.e) * camera.perM, (n) => height / 2 - (n - camera.n) * camera.perM];
    const stroke = (road, fromM, toM, wideM, colour, alpha = 1) => {
      const [a, b] = [ways.at(road, fromM), ways.at(road, toM)];
      paint.globalAlpha = alpha;
      paint.strokeStyle = colour;
      paint.lineWidth = Math.max(wideM * camera.perM, 2);
      paint.beginPath();
      paint.moveTo(x(a[0]), y(a[1]));
      paint.lineTo(x(b[0]), y(b[1]));
      paint.stroke();
      paint.globalAlpha = 1;
    };
    paint.lineCap = "butt";
    state.cast.roads.forEach((road, index) => {
      ways.pieces[index].forEach((piece) => stroke(index, piece.fromM, piece.toM, LANE_M, hue.road));
    });
    state.cast.intersections.forEach((square, index) => {
      for (const [road, atM] of square.legs) stroke(road, atM - square.half_m, atM + square.half_m, LANE_M, hue.line);
      paint.fillStyle = hue.faint;
      paint.font = "12px system-ui";
      paint.textAlign = "left";
      paint.fillText(square.name, x(middles[index][0]) + 10 + 6 * camera.perM, y(middles[index][1]) + 4);
    });
    // A box on a road, with its front at a distance along it.
    const box = (seen, frontM, out, draw) => {
      const long = state.role(seen.id).length_m;
      const [e, n, heading] = ways.at(seen.road, frontM);
      const [length, wide] = [Math.max(long * camera.perM, 6) + 2 * out, Math.max(WIDE[seen.kind] * camera.perM, 4) + 2 * out];
      paint.save();
      paint.translate(x(e), y(n));
      paint.rotate(heading);
      draw(-wide / 2, -out, wide, length);
      paint.restore();
    };
    const found = new Map(vehicles.map((one) => [one.id, one]));
    const isClose = camera.perM >= 0.7; // farther off the numbers of a queue would lie on one another
    for (const one of vehicles) {
      if (one.is_silent || one.id === state.chosen) {
        const ahead = found.get(one.follows);
        if (ahead) {
          const [a, b] = [ways.at(one.road, one.position_m), ways.at(ahead.road, ahead.position_m - state.role(ahead.id).length_m)];
          paint.strokeStyle = one.is_silent ? hue.warn : hue.chosen;
          paint.lineWidth = 1;
          paint.setLineDash([2, 4]);
          paint.beginPath();
          paint.moveTo(x(a[0]), y(a[1]));
          paint.lineTo(x(b[0]), y(b[1]));
          paint.stroke();
          paint.setLineDash([]);
        }
      }
      paint.globalAlpha = one.has_left ? 0.35 : 1;
      box(one, one.position_m, 0, (...rectangle) => {
        paint.fillStyle = one.is_driven ? hue.paper : one.id === state.chosen ? hue.chosen : hue.vehicle;
        paint.fillRect(...rectangle);
        if (state.hit(one.id)) cross(paint, hue.warn, ...rectangle);
        if (!one.is_silent) return;
        paint.strokeStyle = hue.warn;
        paint.lineWidth = 1.5;
        paint.strokeRect(...rectangle);
      });
      if (isClose) {
        const [e, n] = ways.at(one.road, one.position_m);
        paint.fillStyle = hue.ink;
        paint.font = "11px system-ui";
        paint.textAlign = "left";
        paint.fillText(one.place ? `${one.id} · ${one.place}.` : String(one.id), x(e) + 3 + 1.4 * camera.perM, y(n) - 3);
      }
      paint.globalAlpha = 1;
    }
    // Each vehicle as the one behind it believes it to be.
    const ghost = (of, frontM, colour, out) => {
      if (!of || frontM == null) return;
      box(of, frontM, out, (...rectangle) => {
        paint.strokeStyle = colour;
        paint.lineWidth = 1.5;
        paint.setLineDash([5, 3]);
        paint.strokeRect(...rectangle);
        paint.setLineDash([]);
      });
    };
    for (const one of vehicles) {
      const ahead = found.get(one.follows);
      if (byId("newests").checked) ghost(ahead, one.newest_m, hue.newest, 5);
      if (byId("papers").checked) ghost(ahead, one.paper_m, hue.paper, 4);
      const target = byId("ghosts").checked ? one.target : null;
      const of = target ? found.get(target.of) : null;
      if (!of) continue;
      if (target.bound_m) stroke(of.road, target.bound_m[0], target.bound_m[1], LANE_M, hue.ours, 0.3);
      ghost(of, target.position_m, hue.ours, 2);
    }
  }

  function drawLane(vehicles) {
    const [paint, width, height] = prepare(byId("lane"));
    const chosen = vehicles.find((one) => one.id === state.chosen);
    const at = chosen?.next ?? vehicles.find((one) => one.place)?.next ?? 0;
    const square = state.cast.intersections[at];
    const x = (toM) => ((BEFORE_M - toM) / (BEFORE_M + BEYOND_M)) * width;
    const legs = square.legs.map(([road]) => road);
    const row = height / (legs.length + 1);
    const y = (road) => row * (legs.indexOf(road) + 1);
    paint.font = "11px system-ui";
    paint.textAlign = "left";
    paint.fillStyle = hue.line;
    paint.fillRect(x(square.half_m), 0, x(-square.half_m) - x(square.half_m), height);
    paint.fillStyle = hue.faint;
    paint.textAlign = "right";
    paint.fillText(`virtual lane of ${square.name}`, width - 4, height - 5);
    paint.textAlign = "left";
    legs.forEach((road) => {
      paint.fillStyle = hue.road;
      paint.fillRect(0, y(road) - 5, width, 10);
      paint.fillStyle = hue.faint;
      paint.fillText(state.cast.roads[road].name, 4, y(road) - 7);
    });
    const found = new Map(vehicles.map((one) => [one.id, one]));
    paint.textAlign = "center";
    for (const one of vehicles.filter((seen) => seen.next === at && seen.to_m != null)) {
      const [front, rear] = [x(one.to_m), x(one.to_m + state.role(one.id).length_m)];
      paint.fillStyle = one.is_driven ? hue.paper : one.id === state.chosen ? hue.chosen : hue.vehicle;
      paint.fillRect(rear, y(one.road) - 4, front - rear, 8);
      paint.fillStyle = hue.ink;
      paint.fillText(one.place ? `${one.place}.` : "–", front + 10, y(one.road) + 4);
    }
    if (!byId("ghosts").checked) return;
    for (const one of vehicles) {
      const of = one.target ? found.get(one.target.of) : null;
      if (!of || of.next !== at || of.to_m == null) continue;
      const place = (frontM) => x(of.to_m + of.position_m - frontM);
      const { bound_m: bound, position_m: front } = one.target;
      if (bound) {
        paint.globalAlpha = 0.3;
        paint.fillStyle = hue.ours;
        paint.fillRect(place(bound[0]), y(of.road) - 7, place(bound[1]) - place(bound[0]), 14);
        paint.globalAlpha = 1;
      }
      paint.strokeStyle = hue.ours;
      paint.setLineDash([4, 2]);
      const rear = place(front - state.role(of.id).length_m);
      paint.strokeRect(rear, y(of.road) - 5, place(front) - rear, 10);
      paint.setLineDash([]);
    }
  }

  return {
    camera,
    zoom,
    pan,
    draw() {
      const vehicles = now(state);
      drawMap(vehicles);
      drawLane(vehicles);
    },
  };
}
