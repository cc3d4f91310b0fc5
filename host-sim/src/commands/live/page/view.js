// The driver's view: the road and the other vehicles as plain solids in perspective, in WebGL.

import { roads } from "./roads.js";
import { colours, now } from "./scene.js";

const VERTEX = `
attribute vec3 place; attribute vec3 normal; uniform mat4 camera; uniform vec3 at; uniform vec3 size; uniform vec2 turn;
varying float light; varying float far;
vec3 turned(vec3 v) { return vec3(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y, v.z); }
void main() {
  vec4 seen = camera * vec4(turned(place * size) + at, 1.0);
  light = 0.55 + 0.45 * max(0.0, dot(turned(normal), normalize(vec3(-0.4, 0.5, 0.8))));
  far = clamp(seen.w / 260.0, 0.0, 1.0);
  gl_Position = seen;
}`;
const FRAGMENT = `
precision mediump float; uniform vec4 colour; uniform vec3 haze; varying float light; varying float far;
void main() { gl_FragColor = vec4(mix(colour.rgb * light, haze, far * far), colour.a); }`;

// A box from (0, -½, 0) to (1, ½, 1): along the road, to the left, up.
function box() {
  const faces = [
    [[1, 0, 0], [[1, -0.5, 0], [1, 0.5, 0], [1, 0.5, 1], [1, -0.5, 1]]],
    [[-1, 0, 0], [[0, -0.5, 0], [0, -0.5, 1], [0, 0.5, 1], [0, 0.5, 0]]],
    [[0, 1, 0], [[0, 0.5, 0], [0, 0.5, 1], [1, 0.5, 1], [1, 0.5, 0]]],
    [[0, -1, 0], [[0, -0.5, 0], [1, -0.5, 0], [1, -0.5, 1], [0, -0.5, 1]]],
    [[0, 0, 1], [[0, -0.5, 1], [1, -0.5, 1], [1, 0.5, 1], [0, 0.5, 1]]],
  ];
  return new Float32Array(faces.flatMap(([normal, c]) => [c[0], c[1], c[2], c[0], c[2], c[3]].flatMap((p) => [...p, ...normal])));
}

// Looks along the road from the eye: x is along, y to the left, z up.
function camera([ex, ey, ez], aspect, down) {
  const [near, far, f] = [0.3, 600, 1 / Math.tan(0.36)];
  const [c, s] = [Math.cos(down), Math.sin(down)];
  const rows = [[0, -1, 0, ey], [s, 0, c, -s * ex - c * ez], [-c, 0, s, c * ex - s * ez]];
  const [right, up, back] = rows;
  const scaled = [
    right.map((v) => (v * f) / aspect),
    up.map((v) => v * f),
    back.map((v, i) => (v * (far + near)) / (near - far) + (i === 3 ? (2 * far * near) / (near - far) : 0)),
    back.map((v) => -v),
  ];
  return new Float32Array([0, 1, 2, 3].flatMap((column) => scaled.map((row) => row[column]))); // by columns
}

const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);

export function ride(state) {
  const [canvas, rides] = [document.getElementById("view"), document.getElementById("rides")];
  const dash = document.getElementById("dash");
  let hue = colours();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => (hue = colours()));
  let gl = null;
  let places = null;
  const ways = state.isRoad ? roads(state.cast) : null;

  function start() {
    gl = canvas.getContext("webgl", { antialias: true });
    if (!gl) return false;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return false;
    gl.useProgram(program);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, box(), gl.STATIC_DRAW);
    ["place", "normal"].forEach((name, at) => {
      const attribute = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(attribute);
      gl.vertexAttribPointer(attribute, 3, gl.FLOAT, false, 24, at * 12);
    });
    places = Object.fromEntries(["camera", "at", "size", "turn", "colour", "haze"].map((name) => [name, gl.getUniformLocation(program, name)]));
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    return true;
  }
  rides.addEventListener("change", () => {
    canvas.hidden = dash.hidden = !rides.checked;
    if (rides.checked && !gl && !start()) {
      canvas.hidden = dash.hidden = true;
      rides.checked = false;
      rides.disabled = true;
      document.getElementById("said").textContent = "This browser has no WebGL, so there is no driver's view; the road from above stays.";
    }
  });

  // A box whose rear is at a place, turned to the left by an angle.
  function solid(at, size, colour, alpha = 1, angle = 0) {
    gl.uniform2f(places.turn, Math.cos(angle), Math.sin(angle));
    gl.uniform3fv(places.at, at);
    gl.uniform3fv(places.size, size);
    gl.uniform4f(places.colour, ...colour, alpha);
    gl.drawArrays(gl.TRIANGLES, 0, 30);
  }

  function draw() {
    if (!rides.checked || !gl) return;
    const ratio = devicePixelRatio || 1;
    [canvas.width, canvas.height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    const seen = now(state);
    const own = seen.find((one) => one.id === state.chosen);
    if (!own) return;
    const role = state.role(own.id);
    const haze = rgb(hue.sky);
    const gap = own.gap_m == null ? "" : `, gap ${own.gap_m.toFixed(1)} m`;
    const pedals = own.is_driven ? `, you ask for ${own.command_mps2.toFixed(1)} m/s²` : "";
    dash.textContent = `${(own.speed_mps * 3.6).toFixed(0)} km/h, ${own.acceleration_mps2.toFixed(1).replace("-0.0", "0.0")} m/s²${gap}${pedals}`;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...haze, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniform3fv(places.haze, haze);
    if (state.isRoad) {
      drawRoads(seen, own);
      return;
    }
    // All lengths are from the own front bumper, so that they stay small. Of the leader the view is from behind and above: ahead of it
    // is nobody.
    const behindM = state.chosen === 0 ? role.length_m + 9 : 2.1;
    const eye = state.chosen === 0 ? [-behindM, 0, 4] : [-behindM, 0.35, 1.45];
    gl.uniformMatrix4fv(places.camera, false, camera(eye, canvas.width / canvas.height, state.chosen === 0 ? 0.16 : 0.03));
    gl.disable(gl.BLEND);
    solid([-100, 0, -0.3], [700, 400, 0.2], rgb(hue.grass));
    solid([-100, 0, -0.3], [700, 7.5, 0.29], rgb(hue.asphalt));
    const firstM = -(own.position_m % 12) - 24;
    for (let m = firstM; m < 250; m += 12) {
      for (const side of [-1.75, 1.75]) solid([m, side, -0.05], [4, 0.14, 0.07], rgb(hue.paint));
    }
    for (let m = -(own.position_m % 50) - 50; m < 250; m += 50) {
      for (const side of [-5.5, 5.5]) solid([m, side, 0], [0.15, 0.15, 1], rgb(hue.ink));
    }
    seen.forEach((one, index) => {
      if (index === state.chosen && index !== 0) return;
      const long = state.cast.vehicles[index].length_m;
      const tall = long > 8 ? 2.9 : long > 5.5 ? 2.2 : 0.85;
      const rear = one.position_m - own.position_m - long;
      const colour = rgb(one.is_driven ? hue.paper : index === state.chosen ? hue.chosen : hue.vehicle);
      solid([rear, 0, 0.25], [long, 1.8, tall], colour);
      if (tall < 1) solid([rear + long * 0.15, 0, 0.25 + tall], [long * 0.5, 1.6, 0.55], colour.map((c) => c * 0.7));
      for (const side of [-0.7, 0.7]) {
        const brakes = one.acceleration_mps2 < -0.7;
        solid([rear - 0.04, side, 0.7], [0.1, 0.3, 0.2], brakes ? [1, 0.15, 0.1] : [0.45, 0.08, 0.06]);
      }
    });
    // Where the own unit believes the vehicle ahead to be, and what is certain of its rear; and where other methods put it.
    const of = state.cast.vehicles[state.chosen - 1];
    if (!of) return;
    gl.enable(gl.BLEND);
    const at = (frontM) => frontM - own.position_m - of.length_m;
    for (const [frontM, colour] of others(own)) solid([at(frontM), 0, 0.2], [of.length_m, 1.95, 1.5], rgb(colour), 0.3);
    const target = document.getElementById("ghosts").checked ? own.target : null;
    if (!target) return;
    if (target.bound_m) {
      const [low, up] = target.bound_m;
      solid([at(low), 0, 0.02], [up - low, 3.2, 0.03], rgb(hue.ours), 0.55);
    }
    solid([at(target.position_m), 0, 0.2], [of.length_m, 1.95, 1.5], rgb(hue.ours), 0.3);
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
    solid(at(0, 0, 0.25), [long, 1.8, tall], colour, 1, angle);
    if (tall < 1) solid(at(long * 0.15, 0, 0.25 + tall), [long * 0.5, 1.6, 0.55], colour.map((c) => c * 0.7), 1, angle);
    for (const side of [-0.7, 0.7]) {
      const brakes = one.acceleration_mps2 < -0.7;
      solid(at(-0.04, side, 0.7), [0.1, 0.3, 0.2], brakes ? [1, 0.15, 0.1] : [0.45, 0.08, 0.06], 1, angle);
    }
  }

  // Roads that cross. All lengths are from the own front bumper: along the own way, and to its left.
  function drawRoads(seen, own) {
    const [e, n, heading] = ways.at(own.road, own.position_m);
    const [sin, cos] = [Math.sin(heading), Math.cos(heading)];
    const from = (east, north) => [(east - e) * sin + (north - n) * cos, (north - n) * sin - (east - e) * cos];
    const near = ([x, y]) => Math.hypot(x, y) < 330;
    gl.uniformMatrix4fv(places.camera, false, camera([-2.1, 0.35, 1.45], canvas.width / canvas.height, 0.03));
    gl.disable(gl.BLEND);
    solid([-100, 0, -0.5], [700, 700, 0.2], rgb(hue.grass));
    ways.pieces.forEach((pieces, road) => {
      for (const piece of pieces) {
        const [x, y] = from(piece.e, piece.n);
        const angle = heading - Math.atan2(...piece.along);
        const long = piece.toM - piece.fromM;
        // Roads that cross do not lie at the same height, so that neither shimmers through the other.
        const up = -0.3 + 0.004 * road;
        solid([x, y, up], [long, 3.5, 0.25], rgb(hue.asphalt), 1, angle);
        for (const side of [-1.7, 1.7]) {
          const at = [x - side * Math.sin(angle), y + side * Math.cos(angle)];
          solid([...at, up], [long, 0.12, 0.26], rgb(hue.paint), 1, angle);
        }
      }
    });
    // Where the ways cross: the areas that no two vehicles share, and a post at each corner of the crossing.
    state.cast.intersections.forEach((square, index) => {
      const middle = from(...ways.middles[index]);
      if (!near(middle)) return;
      for (const [road, atM] of square.legs) {
        const [east, north, way] = ways.at(road, atM - square.half_m);
        solid([...from(east, north), -0.03 + 0.001 * road], [2 * square.half_m, 3.5, 0.02], rgb(hue.asphalt).map((c) => c * 0.8), 1, heading - way);
      }
      const street = ways.at(square.legs[0][0], square.legs[0][1])[2];
      for (const corner of [1, 3, 5, 7]) {
        const angle = street + (corner * Math.PI) / 4;
        const [x, y] = from(ways.middles[index][0] + 10 * Math.sin(angle), ways.middles[index][1] + 10 * Math.cos(angle));
        solid([x, y, 0], [0.25, 0.25, 3.5], rgb(hue.ink));
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
    gl.enable(gl.BLEND);
    const long = state.role(of.id).length_m;
    const on = (wayM, up, size, alpha, colour = hue.ours) => {
      const [east, north, way] = ways.at(of.road, wayM);
      solid([...from(east, north), up], size, rgb(colour), alpha, heading - way);
    };
    for (const [frontM, colour] of others(own)) on(frontM - long, 0.2, [long, 1.95, 1.5], 0.3, colour);
    if (target?.of !== of.id) return;
    if (target.bound_m) on(target.bound_m[0] - long, 0.02, [target.bound_m[1] - target.bound_m[0], 3.2, 0.03], 0.55);
    on(target.position_m - long, 0.2, [long, 1.95, 1.5], 0.3);
  }

  return { draw };
}
