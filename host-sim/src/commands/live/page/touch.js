// A finger, two fingers, the mouse and its wheel on a canvas enter; a way to move, a factor to zoom by and where, and a tap leave.

const TAP_PX = 4; // a finger is never quite still

// `on`: `move(x, y)` by so many pixels, `zoom(factor, x, y)` about a place on the canvas, `tap(x, y)`.
export function touch(canvas, on) {
  const held = new Map(); // of each pointer that is down, where it is
  let isTap = false;
  const middle = () => {
    const all = [...held.values()];
    return [0, 1].map((axis) => all.reduce((sum, place) => sum + place[axis], 0) / all.length);
  };
  const spread = () => {
    const [a, b] = [...held.values()];
    return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  };
  // Of a pointer that is held, an event's own offset is that of whatever lies below it.
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    on.zoom(Math.exp(-event.deltaY * 0.002), ...place(event));
  }, { passive: false });
  canvas.addEventListener("pointerdown", (event) => {
    held.set(event.pointerId, place(event));
    isTap = held.size === 1;
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held.has(event.pointerId)) return;
    const [from, wide] = [middle(), spread()];
    const before = held.get(event.pointerId);
    const now = place(event);
    if (isTap && Math.hypot(now[0] - before[0], now[1] - before[1]) < TAP_PX) return;
    isTap = false;
    held.set(event.pointerId, now);
    const to = middle();
    on.move(to[0] - from[0], to[1] - from[1]);
    if (wide > 10 && spread() > 10) on.zoom(spread() / wide, ...to);
  });
  const lift = (event) => {
    if (!held.delete(event.pointerId)) return;
    if (isTap && event.type === "pointerup") on.tap(...place(event));
    isTap = false;
  };
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) canvas.addEventListener(end, lift);
}
