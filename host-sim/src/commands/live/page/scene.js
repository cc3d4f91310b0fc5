// The road from above: vehicles, and each as its follower believes it to be, with the bound as a band. Below it the lane in order.

import { touch } from "./touch.js";

const byId = (id) => document.getElementById(id);

// Positions at the time that is drawn, between two scenes.
export function now(state) {
  const { scenes, shownS } = state;
  const later = scenes.findIndex((scene) => scene.at_s >= shownS);
  if (later <= 0) return scenes[later < 0 ? scenes.length - 1 : 0].vehicles;
  const [a, b] = [scenes[later - 1], scenes[later]];
  const share = (shownS - a.at_s) / (b.at_s - a.at_s || 1);
  const between = (x, y) => (x == null || y == null ? y : x + (y - x) * share);
  return b.vehicles.map((seen) => {
    const before = a.byId.get(seen.id);
    if (!before) return seen; // it has just appeared
    const isSame = seen.target && before.target && seen.target.of === before.target.of;
    const target = isSame ? { ...seen.target } : seen.target;
    if (isSame) {
      target.position_m = between(before.target.position_m, target.position_m);
      if (target.bound_m && before.target.bound_m) {
        target.bound_m = target.bound_m.map((end, place) => between(before.target.bound_m[place], end));
      }
    }
    return {
      ...seen,
      target,
      position_m: between(before.position_m, seen.position_m),
      to_m: before.next === seen.next ? between(before.to_m, seen.to_m) : seen.to_m,
      paper_m: seen.follows === before.follows ? between(before.paper_m, seen.paper_m) : seen.paper_m,
      newest_m: seen.follows === before.follows ? between(before.newest_m, seen.newest_m) : seen.newest_m,
    };
  });
}

// The colours of the style sheet, in light and dark.
export function colours() {
  const style = getComputedStyle(document.documentElement);
  const names = ["ground", "ink", "faint", "line", "road", "panel", "ours", "paper", "newest", "warn", "vehicle", "chosen", "sky", "grass",
    "asphalt", "paint"];
  return Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

// How large each canvas is. To ask the canvas itself would lay the page out anew for every plot of every picture.
const sizes = new Map();
const observer = new ResizeObserver((seen) => seen.forEach(({ target }) => sizes.delete(target)));
function sizeOf(canvas) {
  if (!sizes.has(canvas)) {
    sizes.set(canvas, [canvas.clientWidth, canvas.clientHeight]);
    observer.observe(canvas);
  }
  return sizes.get(canvas);
}

// A canvas in the display's own pixels; lengths in it are in CSS pixels.
export function prepare(canvas) {
  const ratio = devicePixelRatio || 1;
  const [width, height] = sizeOf(canvas);
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const paint = canvas.getContext("2d");
  paint.setTransform(ratio, 0, 0, ratio, 0, 0);
  paint.clearRect(0, 0, width, height);
  return [paint, width, height];
}

// Over a vehicle that has collided.
export function cross(paint, colour, left, up, wide, tall) {
  paint.strokeStyle = colour;
  paint.lineWidth = 4;
  paint.strokeRect(left, up, wide, tall);
  paint.beginPath();
  paint.moveTo(left, up);
  paint.lineTo(left + wide, up + tall);
  paint.moveTo(left, up + tall);
  paint.lineTo(left + wide, up);
  paint.stroke();
  paint.lineWidth = 1;
}

export function road(state, choose) {
  const canvas = byId("scene");
  const camera = { middleM: 0, perM: 8 };
  let hue = colours();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => (hue = colours()));

  // What lies under a place stays there. Where the view follows a vehicle, that vehicle does.
  const zoom = (factor, atPx = canvas.clientWidth / 2) => {
    const offPx = byId("follows").checked ? 0 : atPx - canvas.clientWidth / 2;
    const before = camera.perM;
    camera.perM = Math.min(60, Math.max(0.5, camera.perM * factor));
    camera.middleM += offPx / before - offPx / camera.perM;
  };
  const pan = (share) => {
    byId("follows").checked = false;
    camera.middleM += (share * canvas.clientWidth) / camera.perM;
  };
  byId("closer").onclick = () => zoom(1.25);
  byId("farther").onclick = () => zoom(0.8);
  touch(canvas, {
    zoom,
    move: (x) => x !== 0 && pan(-x / canvas.clientWidth),
    tap(x) {
      const atM = camera.middleM + (x - canvas.clientWidth / 2) / camera.perM;
      const hit = (seen, index) => atM <= seen.position_m + 2 && atM >= seen.position_m - state.cast.vehicles[index].length_m - 2;
      const index = now(state).findIndex(hit);
      if (index >= 0) choose(index);
    },
  });

  function drawRoad(seen) {
    const [paint, width, height] = prepare(canvas);
    const x = (positionM) => width / 2 + (positionM - camera.middleM) * camera.perM;
    const [top, bottom] = [height * 0.34, height * 0.66];
    paint.fillStyle = hue.road;
    paint.fillRect(0, top, width, bottom - top);
    // The ground moves past: a mark every 10 m, a number every 50.
    paint.fillStyle = hue.faint;
    paint.font = "11px system-ui";
    paint.textAlign = "center";
    const every = camera.perM < 2 ? 50 : 10;
    const firstM = Math.ceil((camera.middleM - width / 2 / camera.perM) / every) * every;
    for (let m = firstM; x(m) < width; m += every) {
      const isLong = m % 50 === 0;
      paint.fillRect(x(m), bottom, 1, isLong ? 8 : 4);
      if (isLong) paint.fillText(`${m} m`, x(m), bottom + 20);
    }
    const high = bottom - top - 14;
    const box = (frontM, lengthM) => [x(frontM - lengthM), top + 7, lengthM * camera.perM, high];
    seen.forEach((one, index) => {
      const role = state.cast.vehicles[index];
      const [left, up, long, tall] = box(one.position_m, role.length_m);
      if (one.is_silent) {
        const [ahead, aheadRole] = [seen[index - 1], state.cast.vehicles[index - 1]];
        const from = x(ahead.position_m - aheadRole.length_m);
        paint.strokeStyle = hue.warn;
        paint.setLineDash([2, 4]);
        paint.beginPath();
        paint.moveTo(left + long, height / 2);
        paint.lineTo(from, height / 2);
        paint.stroke();
        paint.setLineDash([]);
        paint.fillStyle = hue.warn;
        paint.fillText("silent", (left + long + from) / 2, height / 2 - 4);
      }
      paint.fillStyle = one.is_driven ? hue.paper : index === state.chosen ? hue.chosen : hue.vehicle;
      paint.fillRect(left, up, long, tall);
      paint.fillStyle = hue.ink;
      paint.fillText(`${index + 1}. ${role.name}`, left + long / 2, top - 22);
      paint.fillStyle = hue.faint;
      paint.fillText(`${one.speed_mps.toFixed(1)} m/s`, left + long / 2, top - 8);
      if (state.hit(index)) cross(paint, hue.warn, left, up, long, tall);
    });
    // Each vehicle as its follower believes it to be.
    seen.forEach((one, index) => {
      if (index === 0) return;
      const lengthM = state.cast.vehicles[index - 1].length_m;
      const ghost = (frontM, hueOf, out) => {
        if (frontM == null) return;
        const [left, up, long, tall] = box(frontM, lengthM);
        paint.strokeStyle = hueOf;
        paint.lineWidth = 2;
        paint.setLineDash([5, 3]);
        paint.strokeRect(left, up - out, long, tall + 2 * out);
        paint.setLineDash([]);
        paint.lineWidth = 1;
      };
      if (byId("newests").checked) ghost(one.newest_m, hue.newest, 10);
      if (byId("papers").checked) ghost(one.paper_m, hue.paper, 7);
      if (byId("ghosts").checked && one.target) {
        if (one.target.bound_m) {
          const [low, up] = one.target.bound_m;
          paint.fillStyle = hue.ours;
          paint.globalAlpha = 0.25;
          paint.fillRect(x(low), top - 3, (up - low) * camera.perM, bottom - top + 6);
          paint.globalAlpha = 1;
          paint.fillRect(x(low) - 1, top - 3, 2, bottom - top + 6);
          paint.fillRect(x(up) - 1, top - 3, 2, bottom - top + 6);
        }
        ghost(one.target.position_m, hue.ours, 4);
      }
    });
  }

  function drawLane(seen) {
    const [paint, width, height] = prepare(byId("lane"));
    const [lastM, firstM] = [seen.at(-1).position_m - 20, seen[0].position_m + 10];
    const x = (positionM) => ((positionM - lastM) / (firstM - lastM)) * width;
    paint.font = "11px system-ui";
    paint.textAlign = "center";
    paint.fillStyle = hue.road;
    paint.fillRect(0, height / 2 - 8, width, 16);
    seen.forEach((one, index) => {
      const role = state.cast.vehicles[index];
      const left = x(one.position_m - role.length_m);
      paint.fillStyle = one.is_driven ? hue.paper : index === state.chosen ? hue.chosen : hue.vehicle;
      paint.fillRect(left, height / 2 - 7, x(one.position_m) - left, 14);
      paint.fillStyle = hue.ink;
      paint.fillText(String(index + 1), (left + x(one.position_m)) / 2, height / 2 - 14);
      if (one.gap_m != null) {
        paint.fillStyle = one.gap_m < 0 ? hue.warn : hue.faint;
        paint.fillText(`${one.gap_m.toFixed(1)} m`, x(one.position_m + one.gap_m / 2), height / 2 + 22);
      }
    });
  }

  return {
    camera,
    zoom,
    pan,
    draw() {
      const seen = now(state);
      if (byId("follows").checked) {
        const aheadM = Math.min(10, canvas.clientWidth / camera.perM / 6);
        camera.middleM = seen[state.chosen].position_m + aheadM;
      }
      drawRoad(seen);
      drawLane(seen);
    },
  };
}
