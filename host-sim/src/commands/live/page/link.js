// The link to the engine: orders leave, scenes enter. What the engine refuses is said in the status line.

const said = document.getElementById("said");

export function say(text) {
  said.textContent = text;
}

// For those who hear the page: one thing after the other, no faster than they can listen. `what` says it when its turn has come, as things
// are then, and nothing if there is nothing left to say.
const told = document.getElementById("told");
const turns = [];
let until = 0;
export function announce(what) {
  if (turns.includes(what)) return;
  turns.push(what);
  if (turns.length === 1) wait();
}
function wait() {
  setTimeout(() => {
    const text = turns[0]();
    turns.shift();
    if (text) {
      told.textContent = text;
      until = performance.now() + 1500;
    }
    if (turns.length) wait();
  }, Math.max(0, until - performance.now()));
}

// Resolves to whether the engine has done it. Orders are sent one after the other, so that none overtakes another one.
let sent = Promise.resolve();
export function order(what) {
  sent = sent.then(() => send(what));
  return sent;
}

async function send(what) {
  try {
    const answer = await fetch("/order", { method: "POST", body: JSON.stringify(what) });
    say(answer.ok ? "" : await answer.text());
    return answer.ok;
  } catch {
    say("The simulation does not answer. Is holdover-sim still running?");
    return false;
  }
}

export async function get(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(await answer.text());
  return answer;
}

export function listen(take) {
  const source = new EventSource("/scenes");
  let lost = false;
  source.onmessage = (message) => {
    if (lost) say("The simulation is there again.");
    lost = false;
    const scene = JSON.parse(message.data);
    if (scene.vehicles) take(scene);
  };
  source.onerror = () => {
    lost = true;
    say("The simulation is not there; this page tries again.");
  };
}
