// The paper's experiment as a guided tour: what to look at, and the orders that bring it about.

import { order } from "./link.js";

const byId = (id) => document.getElementById(id);
// The largest error that the paper reports over its four seconds without a message, with people who drive, in metres.
const PAPER_M = 0.5;
const LATE = { delay_mean_s: 0.04, delay_std_s: 0.0259, loss: 0.1 }; // the paper's link

const links = (radio) => order({ do: "links", vehicle: null, ...radio });
const set = (part, on) => order({ do: "switch", vehicle: null, part, on });

const STEPS = [
  {
    name: "perfect link",
    // Where the run has hardly begun, a new start may not be told from going on.
    goesBack: (nowS) => nowS > 1,
    text: "1. A perfect link. Every message arrives at once. The dashed outline is the vehicle ahead as its follower believes it to be; the " +
      "band is what is certain. Range sensors and envelope are off, as in the paper: the vehicles know one another by messages alone.",
    async begin() {
      await order({ do: "restart" });
      await set("range_sensor", false);
      await set("envelope", false);
      await links({ delay_mean_s: 0, delay_std_s: 0, loss: 0 });
      byId("ghosts").checked = true;
    },
  },
  {
    name: "late and lossy",
    text: "2. Late and lossy: 40 ms of delay, more or less, and one message in ten is lost. The outline stays on the vehicle. The literal " +
      "paper's outline does not: that method adds no time to what it heard.",
    async begin() {
      await links(LATE);
      byId("papers").checked = true;
    },
  },
  {
    name: "4 s of silence",
    paperM: PAPER_M,
    text: "3. Four seconds of silence. No message reaches the ego or leaves it. Its follower goes on by the estimate; watch the band grow, " +
      "and come back with the first message.",
    async begin(state) {
      this.atS = state.scene.at_s;
      await order({ do: "outage", vehicle: state.cast.ego, seconds: 4 });
    },
  },
  {
    name: "without the estimate",
    isPlain: true,
    goesBack: (nowS) => nowS > STEPS[2].atS,
    text: "4. The same four seconds without the estimate. Time goes back to where the silence began. Who hears nothing takes the newest " +
      "message as it stands, brakes behind a vehicle that is not there any more, and everyone behind brakes too.",
    async begin(state) {
      const back = Math.max(0, state.scene.at_s - STEPS[2].atS);
      await order({ do: "back", seconds: back });
      await set("holdover", false);
      await order({ do: "outage", vehicle: state.cast.ego, seconds: 4 });
    },
  },
  {
    name: "you drive",
    paperM: PAPER_M,
    text: "5. You drive the leader, with the arrow keys or the pedals, and silence comes every ten seconds. What you will do, no unit knows " +
      "beforehand: that was the paper's experiment with people. Drive for half a minute, then see the figures.",
    async begin(state) {
      await set("holdover", true);
      await links(LATE);
      globalThis.holdover.choose(0);
      this.silentS = state.scene.at_s + 3;
    },
  },
];

export function tour(state) {
  // It is of the paper's string of vehicles, and goes back in time.
  if (state.isRoad || state.cast.device != null) {
    byId("tour").hidden = true;
    return {};
  }
  let at = -1; // before the first step
  let figures = STEPS.map(() => null);
  let settledS = Infinity; // figures count from then on
  let isAwaited = false; // time is to go back, and the scenes until then are of before

  function show() {
    const step = STEPS[at];
    byId("tour-text").textContent = step?.text ??
      (at < 0
        ? "A perfect link; late and lossy; four seconds of silence with the estimate; the same without; and you drive the leader."
        : "Your errors: how far the vehicle ahead was from where its follower took it to be. Without the estimate that is where the newest " +
          "message said. The paper reports at most ±0.5 m over its four seconds of silence, with people who drive.");
    byId("tour-next").textContent = at < 0 ? "Begin" : at < STEPS.length - 1 ? "Next" : at < STEPS.length ? "See the figures" : "Again";
    byId("tour-next").disabled = false;
    const table = byId("tour-figures");
    table.hidden = at < STEPS.length;
    if (table.hidden) return;
    const number = (value) => (value == null ? "–" : value.toFixed(2));
    const rows = STEPS.map((one, place) => [one.name, ...(figures[place] ?? [null, null]).map(number), number(one.paperM)]);
    table.tBodies[0].replaceChildren(...rows.map((row) => {
      const line = document.createElement("tr");
      const [name, ...cells] = row;
      const head = document.createElement("th");
      [head.scope, head.textContent] = ["row", name];
      line.append(head);
      cells.forEach((text) => (line.insertCell().textContent = text));
      return line;
    }));
  }

  byId("tour-next").onclick = async () => {
    byId("tour-next").disabled = true;
    at = at >= STEPS.length ? 0 : at + 1;
    if (at === 0) figures = STEPS.map(() => null);
    settledS = Infinity;
    if (at < STEPS.length) {
      const step = STEPS[at];
      const nowS = () => state.scene?.at_s ?? 0;
      isAwaited ||= step.goesBack?.(nowS()) ?? false;
      await order({ do: "play" });
      await step.begin(state);
      if (!isAwaited && settledS === Infinity) settledS = nowS() + 1;
    }
    show();
  };
  show();

  return {
    rewind(scene) {
      if (isAwaited) [isAwaited, settledS] = [false, scene.at_s + 1];
    },
    // The estimate of the ego by its follower, or by the ego of the vehicle ahead.
    take(scene) {
      if (at < 0 || at >= STEPS.length || scene.at_s < settledS) return;
      const ego = state.cast.ego;
      const by = ego + 1 < scene.vehicles.length ? ego + 1 : ego;
      const seen = scene.vehicles[by];
      const truth = scene.vehicles[by - 1].position_m;
      const off = (position) => (position == null ? null : position - truth);
      const ours = STEPS[at].isPlain ? off(seen.newest_m) : seen.target?.error_m;
      figures[at] = [ours, off(seen.paper_m)].map((error, place) => {
        const before = figures[at]?.[place] ?? null;
        return error == null ? before : Math.max(before ?? 0, Math.abs(error));
      });
      const step = STEPS[at];
      if (at === STEPS.length - 1 && scene.at_s >= step.silentS) {
        step.silentS = scene.at_s + 10;
        order({ do: "outage", vehicle: ego, seconds: 4 });
      }
    },
  };
}
