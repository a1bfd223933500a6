// Mouse, touch, keys and buttons.
const $ = (id) => document.getElementById(id);

// What colors mean: title of the legend, unit, and how many SI units one of it is.
const quantities = {
  strain: ["strain of the springs", " %", 0.01], "signed-strain": ["strain: − shortened, + stretched", " %", 0.01],
  actuation: ["change of rest lengths: − shortened, + stretched", " %", 0.01],
  speed: ["speed", " m/s", 1], force: ["force of the springs", " N", 1], energy: ["energy of the springs", " J", 1],
};
const colors = ["material", ...Object.keys(quantities).filter((color) => color !== "actuation"), "type", "actuation"];
const hasSign = (color) => color === "signed-strain" || color === "actuation";

// Drags of one finger or the mouse orbit, those of two fingers or with Shift or the right button pan, pinches and the wheel zoom.
function watchPointers(canvas, camera, changed) {
  const fingers = new Map();
  const middle = () => times(1 / fingers.size, [...fingers.values()].map(({ x, y }) => [x, y, 0]).reduce(plus));
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return;
    const before = middle(), wide = spread();
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const [right, down] = minus(middle(), before), size = canvas.clientHeight;
    if (fingers.size > 1 || event.shiftKey || event.buttons & 2) camera.pan(right / size, -down / size);
    else camera.orbit((4 * right) / size, (4 * down) / size);
    if (fingers.size > 1 && spread() > 0) camera.zoom(wide / spread());
    changed();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("dblclick", () => {
    camera.reset();
    changed();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(0.0015 * event.deltaY * (event.deltaMode === 1 ? 30 : 1)));
    changed();
  }, { passive: false });
}

// Keys, what they do, and what the list of keys says of them.
function keyTable({ player, camera, look, setColor, setLook, press }) {
  const turn = 0.1;
  return [
    [" ", "Space", "play or pause", () => press("play")],
    ["ArrowLeft", "←", "one frame back; with Shift, ten", (shift) => player.step(shift ? -10 : -1)],
    ["ArrowRight", "→", "one frame forward; with Shift, ten", (shift) => player.step(shift ? 10 : 1)],
    ["Home", "Home", "go to the start", () => player.seek(-Infinity)],
    ["End", "End", "go to the end", () => player.seek(Infinity)],
    ["[", "[", "slower", () => player.faster(-1)],
    ["]", "]", "faster", () => player.faster(1)],
    ["l", "L", "repeat the run or not", () => press("loop")],
    ["a", "A", "turn the camera left", () => camera.orbit(turn, 0)],
    ["d", "D", "turn the camera right", () => camera.orbit(-turn, 0)],
    ["w", "W", "raise the camera", () => camera.orbit(0, turn)],
    ["s", "S", "lower the camera", () => camera.orbit(0, -turn)],
    ["+", "+", "zoom in", () => camera.zoom(0.9)],
    ["-", "−", "zoom out", () => camera.zoom(1 / 0.9)],
    ["r", "R", "reset the view", () => camera.reset()],
    ["b", "B", "show or hide surfaces", () => setLook("solid", !look.solid)],
    ["k", "K", "show or hide springs", () => types.forEach((type, i, all) => setLook(type, !all.slice(0, i).concat(type).some((t) => look[t])))],
    ["p", "P", "show or hide particles", () => setLook("particles", !look.particles)],
    ["x", "X", "show or hide axes", () => setLook("axes", !look.axes)],
    ...colors.map((color, i) => [String(i + 1), String(i + 1), `color by ${color.replace("-", " ")}`, () => setColor(color)]),
    ...($("copy").hidden ? [] : [["c", "C", "copy the command", () => press("copy")]]),
    ["t", "T", "switch between light and dark", () => press("theme")],
    ...($("live").hidden ? [] : [["n", "N", "restart with the present values", () => press("restart")]]),
    ["?", "?", "show this list", () => press("help")],
  ];
}

function watchKeys(table, changed) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target, key } = event;
    if ($("keys").open && key !== "?") return;
    // The elements' own keys come first.
    if (target.matches("input[type=text]")) return;
    if (target.matches("select, input[type=range]") && (key.startsWith("Arrow") || key === "Home" || key === "End")) return;
    if (key === " " && target.matches("button, input, summary, select, a")) return;
    const row = table.find(([own]) => own === (key.length === 1 ? key.toLowerCase() : key) || (own === "+" && key === "="));
    if (!row) return;
    event.preventDefault();
    row[3](event.shiftKey);
    changed();
  });
  $("keys-list").replaceChildren(...table.flatMap(([, name, what]) => {
    const dt = document.createElement("dt"), dd = document.createElement("dd"), kbd = document.createElement("kbd");
    kbd.textContent = name;
    dt.append(kbd);
    dd.textContent = what;
    return [dt, dd];
  }));
}

// A table of labels and values.
function rowsOf(pairs) {
  return pairs.map(([label, value]) => {
    const row = document.createElement("tr"), head = document.createElement("th"), cell = document.createElement("td");
    head.scope = "row";
    head.textContent = label;
    cell.textContent = value;
    row.append(head, cell);
    return row;
  });
}

// Copies a text; the clipboard's modern interface is closed to files in some browsers.
async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
}
