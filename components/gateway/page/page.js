// Joins the connection, the pictures and the panel.

const cloud = new CloudCanvas(element("cloud"));
const plate = new PlateCanvas(element("plate"));
const overlay = element("overlay");
let state = null;
let number = 0;         // of the picture on show; older frames are not for it
let lines = 0;          // of the whole picture, and how far they are in
let beams = 0;
let ceilingChosen = false;
let redraw = false;
let plateDirty = false;
let frames = [];        // instants of the last drawings

// ---- what comes in

function begin(head) {
  [number, lines, beams] = [head.number, head.lines, head.beams];
  cloud.points = new Int16Array(4 * lines * beams);
  cloud.count = 0;
  plate.clear();
  colourByTrust();
  redraw = true;
}

function takePoints(buffer) {
  const [kind, picture, allLines, allBeams, first, count] = new Uint32Array(buffer, 0, 6);
  if (picture < number) return;
  if (picture > number) begin({ number: picture, lines: allLines, beams: allBeams });
  cloud.points.set(new Int16Array(buffer, 24, 4 * count * beams), 4 * first * beams);
  const end = (first + count) * beams;
  cloud.count = Math.max(cloud.count, end);
  if (kind === 2) document.body.dataset.cloud = picture;
  settleHeights(kind === 2 || first % 8 === 0);
  if (state && state.plate) plate.add(cloud.points, first * beams, end, state.plate);
  plateDirty = true;
  if (!redraw) cloud.splat(first * beams, end);
  present();
}

// Colours go from floor to ceiling, and the ceiling is clipped until somebody moves the slider.
function settleHeights(look) {
  const found = look ? cloud.heights() : null;
  if (!found) return;
  const moved = Math.abs(found.low_mm - cloud.low_mm) > 300 || Math.abs(found.high_mm - cloud.high_mm) > 300;
  if (cloud.low_mm !== undefined && !moved) return;
  Object.assign(cloud, found);
  if (!ceilingChosen) setCeiling((found.high_mm - 300) / 1000);
  redraw = true;
}

// What was said of an earlier picture is not said of this one.
function colourByTrust() {
  const told = state !== null && state.picture.number === number;
  const level = told && { good: "good", bad: "bad" }[state.trust.level] || "running";
  if (!told) document.body.dataset.trust = "waiting";
  if (level !== cloud.level) redraw = true;
  cloud.level = level;
}

function takeState(next) {
  const firstPlate = next.plate && !(state && state.plate);
  state = next;
  if (firstPlate) plate.add(cloud.points, 0, cloud.count, next.plate);
  plateDirty = true;
  colourByTrust();
  showState(next, send);
  present();
}

let socket = null;

function connect() {
  const token = new URLSearchParams(location.search).get("token");
  const query = token ? `?token=${encodeURIComponent(token)}` : "";
  socket = new WebSocket(`ws://${location.host}/live${query}`, "swivel.view.v1");
  socket.binaryType = "arraybuffer";
  socket.onopen = () => {
    setText("link", "connected");
    element("link").className = "up";
    number = 0;  // the gateway may be another one, with a count of its own
  };
  socket.onmessage = ({ data }) => typeof data === "string" ? takeState(JSON.parse(data)) : takePoints(data);
  socket.onclose = () => {
    setText("link", "connection lost; trying again");
    element("link").className = "";
    document.body.dataset.trust = "nothing";  // what is on show may be old
    setTimeout(connect, 1000);
  };
}

function send(command) {
  if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(command));
}

// ---- what is drawn

let awaited = false;

function present() {
  if (awaited) return;
  awaited = true;
  requestAnimationFrame(drawFrame);
}

function drawFrame() {
  awaited = false;
  const before = performance.now();
  cloud.low_mm ??= -1500;
  cloud.high_mm ??= 1500;
  if (redraw) cloud.draw(); else cloud.present();
  redraw = false;
  drawOverlay();
  if (plateDirty && state && state.plate) drawPlate();
  plateDirty = false;
  const now = performance.now();
  frames = frames.filter((instant) => now - instant < 1000).concat(now);
  setText("numbers", `${cloud.shown.toLocaleString("en")} points drawn, ${(now - before).toFixed(0)} ms`);
  document.body.dataset.frames = frames.length;  // of the last second
  document.body.dataset.points = cloud.shown;
  document.body.dataset.drawing = now - before;  // ms
}

function drawPlate() {
  const corrected = state.attitude && state.picture.in_base && state.trust.level === "good";
  const colours = { good: "#56b4e9", bad: "#e8703a" };
  plate.draw(state.plate, corrected ? state.attitude.alpha_deg : null, colours[state.trust.level] ?? "#c9ced6");
  setText("plate-words", corrected ? "The points should fill the yellow outline." :
      "Where it stands in this cloud is not known: no outline.");
}

// Axes at the rig, and a bar of one metre.
function drawOverlay() {
  overlay.width = overlay.clientWidth;
  overlay.height = overlay.clientHeight;
  const pen = overlay.getContext("2d");
  pen.font = "12px sans-serif";
  pen.lineWidth = 2;
  const origin = cloud.project(0, 0, 0);
  for (const [name, colour, place] of [["X front", "#f0e442", [1000, 0, 0]], ["Y", "#9aa6b4", [0, 1000, 0]]]) {
    const end = cloud.project(...place);
    if (!origin || !end) continue;
    pen.strokeStyle = pen.fillStyle = colour;
    pen.beginPath();
    pen.moveTo(...origin);
    pen.lineTo(...end);
    pen.stroke();
    pen.fillText(name, end[0] + 5, end[1] + 4);
  }
}

// ---- how one looks at it

const VIEWS = {
  oblique: { azimuth: -2.5, elevation: 0.85, distance_mm: 11000 },
  above: { azimuth: -Math.PI / 2, elevation: Math.PI / 2, distance_mm: 10000 },
  inside: { azimuth: Math.PI, elevation: 0.12, distance_mm: 300 },
};

function look(name) {
  Object.assign(cloud.eye, VIEWS[name], { target: [0, 0, 0] });
  lookAgain();
}

function lookAgain() {
  redraw = true;
  present();
}

function setCeiling(metres) {
  cloud.ceiling_mm = 1000 * metres;
  element("ceiling").value = metres;
  setText("ceiling-words", `${Number(metres).toFixed(2)} m`);
}

function drag(event) {
  if (event.buttons === 0) return;
  const { eye } = cloud;
  const pan = event.shiftKey || event.buttons === 2;
  if (pan) {
    const [right, down] = cloud.turn();
    const step = eye.distance_mm / cloud.focal();
    for (const k of [0, 1, 2]) eye.target[k] -= step * (event.movementX * right[k] + event.movementY * down[k]);
  } else {
    eye.azimuth -= 0.006 * event.movementX;
    eye.elevation = Math.max(-1.57, Math.min(1.5708, eye.elevation + 0.006 * event.movementY));
  }
  lookAgain();
}

element("cloud").addEventListener("pointerdown", (event) => event.target.setPointerCapture(event.pointerId));
element("cloud").addEventListener("pointermove", drag);
element("cloud").addEventListener("contextmenu", (event) => event.preventDefault());
element("cloud").addEventListener("wheel", (event) => {
  event.preventDefault();
  cloud.eye.distance_mm = Math.max(100, Math.min(60000, cloud.eye.distance_mm * Math.exp(0.0012 * event.deltaY)));
  lookAgain();
}, { passive: false });
element("ceiling").addEventListener("input", (event) => {
  ceilingChosen = true;
  setCeiling(event.target.value);
  lookAgain();
});
element("cancel").addEventListener("click", () => send({ do: "cancel" }));
for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => look(button.dataset.view));
new ResizeObserver(lookAgain).observe(element("cloud"));

setCeiling(3);
connect();
lookAgain();
