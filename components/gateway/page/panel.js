// The words at the side: verdict, facts, modes, participants. Everything that comes from the rig
// goes in as text, never as HTML.

const element = (id) => document.getElementById(id);

function setText(id, words) {
  if (element(id).textContent !== words) element(id).textContent = words;
}

function made(tag, words, className) {
  const node = document.createElement(tag);
  node.textContent = words;
  if (className) node.className = className;
  return node;
}

const degrees = (value, digits = 3) => value === null ? "not known" : `${value.toFixed(digits)}°`;

function facts(state) {
  const { attitude, picture } = state;
  const rows = [];
  if (picture.kind !== "none") rows.push(["mode", picture.mode ? `${picture.mode}` : "not known"],
                                         ["lines", `${picture.lines_in} of ${picture.lines}`]);
  if (!attitude) return rows;
  rows.push(["turned by", degrees(attitude.phi_offset_deg)]);
  if (attitude.sigma_deg > 0) rows.push(["sigma", degrees(attitude.sigma_deg)]);
  if (attitude.sigma_deg > 0 && attitude.calibrated) {
    const wall_mm = 10000 * Math.tan(2 * attitude.sigma_deg * Math.PI / 180);
    rows.push(["a wall 10 m off", `within ${wall_mm.toFixed(0)} mm (2 sigma)`]);
  }
  if (attitude.seam_deg !== null) rows.push(["seam", `${degrees(attitude.seam_deg)} ± ${degrees(attitude.seam_sigma_deg)}`]);
  rows.push(["plate's points", `${attitude.points_used}`]);
  if (attitude.points_used > 0) rows.push(["alpha", degrees(attitude.alpha_deg) + (attitude.calibrated ? "" : ", as drawn")]);
  return rows;
}

function showVerdict(state) {
  document.body.dataset.trust = state.trust.level;
  document.body.dataset.kind = state.picture.kind;
  setText("headline", state.trust.headline);
  setText("reason", state.trust.reason);
  setText("warning", state.attitude?.warning ?? "");
  element("facts").replaceChildren(...facts(state).flatMap(([name, value]) => [made("dt", name), made("dd", value)]));
  const words = { good: "Corrected", bad: "Not to be trusted", running: "Scanning", waiting: "Wait", nothing: "No sweep yet" };
  setText("badge-word", words[state.trust.level]);
  setText("badge-words", { good: state.trust.headline === "Good" ? "the cloud stands in the rig's frame" : state.trust.headline.toLowerCase(), bad: state.trust.headline, nothing: "" }[state.trust.level] ??
      `${state.picture.lines_in} of ${state.picture.lines} lines, start angle unknown`);
  const running = state.trust.level === "running";
  element("progress").firstElementChild.style.width = running ? `${100 * state.picture.lines_in / Math.max(state.picture.lines, 1)}%` : "0";
}

function showModes(state, send) {
  const box = element("modes");
  if (box.childElementCount !== state.modes.length) {
    box.replaceChildren(...state.modes.map(({ mode, seconds }) => {
      const button = made("button", `${mode}`);
      button.append(made("small", `${seconds} s`));
      button.dataset.mode = mode;
      button.title = `One sweep of ${seconds} s`;
      button.addEventListener("click", () => send({ do: "scan", mode }));
      return button;
    }));
  }
  const ready = state.motor.known && state.motor.idle;
  for (const button of box.children) button.disabled = !ready;
  element("cancel").disabled = !state.motor.known || ready || state.motor.phase === "fault";
  setText("motor", state.motor.known ? state.motor.phase : "no stepper_sequencer");
  setText("answer", state.answer || (state.motor.phase === "fault" ? state.motor.reason : ""));
}

function participantItem([name, health]) {
  const gone = health.age_s > 3;
  const item = made("li", name, gone ? "gone" : health.state);
  item.prepend(made("i", gone ? `not heard for ${health.age_s.toFixed(0)} s` : health.state));
  item.append(made("small", health.doing));
  if (health.last_error) item.append(made("small", `${(health.last_error_age_s ?? 0).toFixed(0)} s ago: ${health.last_error}`, "error"));
  return item;
}

function showParticipants(participants) {
  if (Object.keys(participants).length === 0) return;
  element("participants").replaceChildren(...Object.entries(participants).map(participantItem));
}

function showState(state, send) {
  setText("rig", state.rig);
  showVerdict(state);
  showModes(state, send);
  showParticipants(state.participants);
  element("plate-section").hidden = state.plate === null;
}
