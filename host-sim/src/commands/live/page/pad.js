// Gamepads: what the devices report enters; what they ask for leaves, from -1, the hardest braking, to 1, and whether to let go.

const DEAD = 0.1; // no trigger and no stick comes back to its middle quite
const STEPS = 20; // finer than this nobody can hold a trigger

const free = (value) => (Math.abs(value) < DEAD ? 0 : (Math.sign(value) * (Math.abs(value) - DEAD)) / (1 - DEAD));

export function gamepads(shown) {
  const rested = new Set(); // devices in a layout of their own whose axis has been in its middle
  let said = null;

  return () => {
    const found = [...(navigator.getGamepads?.() ?? [])].filter((one) => one?.connected);
    let asked = 0;
    for (const one of found) {
      let at = free(one.buttons[7]?.value ?? 0) - free(one.buttons[6]?.value ?? 0);
      if (one.mapping !== "standard") {
        // A wheel's pedals are often an axis. Some lie at an end of it until they are touched: that asks for nothing.
        const axis = free(one.axes[1] ?? 0);
        if (axis === 0) rested.add(one.index);
        at = rested.has(one.index) ? -axis : 0;
      }
      if (Math.abs(at) > Math.abs(asked)) asked = at;
    }
    for (const index of rested) if (!found.some((one) => one.index === index)) rested.delete(index);
    const says = found.length ? `${found.map((one) => one.id || "one").join(", ").slice(0, 60)} is there` : null;
    if (says !== said) {
      said = says;
      shown.textContent = says ?? "none is there; press one of its buttons";
    }
    return { at: Math.round(asked * STEPS) / STEPS, isLetGo: found.some((one) => one.buttons[0]?.pressed) };
  };
}
