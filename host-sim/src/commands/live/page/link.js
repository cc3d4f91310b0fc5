// The link to the engine: orders leave, scenes enter. What the engine refuses is said in the status line.

const said = document.getElementById("said");

export function say(text) {
  said.textContent = text;
}

// Resolves to whether the engine has done it.
export async function order(what) {
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
    if (lost) say("");
    lost = false;
    const scene = JSON.parse(message.data);
    if (scene.vehicles) take(scene);
  };
  source.onerror = () => {
    lost = true;
    say("The simulation is not there; this page tries again.");
  };
}
