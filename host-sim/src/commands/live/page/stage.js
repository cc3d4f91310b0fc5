// Solids in perspective: boxes that are put up anew for each picture, drawn by OGL.

import { Camera } from "./ogl/core/Camera.js";
import { Mesh } from "./ogl/core/Mesh.js";
import { Program } from "./ogl/core/Program.js";
import { Renderer } from "./ogl/core/Renderer.js";
import { Transform } from "./ogl/core/Transform.js";
import { Box } from "./ogl/extras/Box.js";

const VERTEX = `
attribute vec3 position; attribute vec3 normal; uniform mat4 modelMatrix; uniform mat4 modelViewMatrix; uniform mat4 projectionMatrix;
varying float light; varying float far;
void main() {
  vec4 seen = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  light = 0.55 + 0.45 * max(0.0, dot(normalize(mat3(modelMatrix) * normal), normalize(vec3(-0.4, 0.5, 0.8))));
  far = clamp(seen.w / 260.0, 0.0, 1.0);
  gl_Position = seen;
}`;
const FRAGMENT = `
precision mediump float; uniform vec4 colour; uniform vec3 haze; varying float light; varying float far;
void main() { gl_FragColor = vec4(mix(colour.rgb * light, haze, far * far), colour.a); }`;

// A stage on a canvas: x is along the road, y to the left, z up, in metres. None if the browser has no WebGL.
export function stage(canvas) {
  // The library throws where there is no WebGL, so another canvas is asked first.
  const other = document.createElement("canvas");
  if (!other.getContext("webgl2") && !other.getContext("webgl")) return null;
  const renderer = new Renderer({ canvas, antialias: true });
  const { gl } = renderer;
  const [haze, colour] = [{ value: [0, 0, 0] }, { value: [0, 0, 0, 1] }];
  const program = (transparent) => new Program(gl, { vertex: VERTEX, fragment: FRAGMENT, uniforms: { haze, colour }, transparent });
  const [scene, geometry] = [new Transform(), new Box(gl)];
  const kinds = [false, true].map((transparent) => ({ program: program(transparent), meshes: [], used: 0 }));
  const camera = new Camera(gl, { near: 0.3, far: 600, fov: 41.25 });
  camera.up.set(0, 0, 1);

  // A mesh of a kind that stands nowhere yet. Meshes stay from picture to picture.
  function free(kind) {
    if (kind.used === kind.meshes.length) {
      const mesh = new Mesh(gl, { geometry, program: kind.program });
      mesh.onBeforeRender(() => (colour.value = mesh.colour));
      mesh.setParent(scene);
      kind.meshes.push(mesh);
    }
    return kind.meshes[kind.used++];
  }

  return {
    // Begins a picture, with the colour of the sky.
    begin(sky) {
      const [dpr, wide, high] = [devicePixelRatio || 1, canvas.clientWidth, canvas.clientHeight];
      if (renderer.dpr !== dpr || renderer.width !== wide || renderer.height !== high) {
        renderer.dpr = dpr;
        renderer.setSize(wide, high);
        canvas.style.width = canvas.style.height = ""; // the style sheet says how large it is
        camera.perspective({ aspect: wide / high });
      }
      haze.value = sky;
      gl.clearColor(...sky, 1);
      for (const kind of kinds) kind.used = 0;
    },
    // Looks along the road from the eye, by an angle down.
    look([x, y, z], down) {
      camera.position.set(x, y, z);
      camera.lookAt([x + Math.cos(down), y, z - Math.sin(down)]);
    },
    // A box with the middle of its lower rear edge at a place, turned to the left by an angle.
    add([x, y, z], [long, wide, high], [red, green, blue], alpha = 1, angle = 0) {
      const mesh = free(kinds[alpha < 1 ? 1 : 0]);
      mesh.position.set(x + (Math.cos(angle) * long) / 2, y + (Math.sin(angle) * long) / 2, z + high / 2);
      mesh.scale.set(long, wide, high);
      mesh.rotation.z = angle;
      mesh.colour = [red, green, blue, alpha];
    },
    // Shows the picture.
    show() {
      for (const { meshes, used } of kinds) meshes.forEach((mesh, at) => (mesh.visible = at < used));
      renderer.render({ scene, camera });
    },
  };
}
