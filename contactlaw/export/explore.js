// The page: what is asked, in SI units and degrees, and all that follows from it.
const SLIDERS = { // unit and its size; ends: from 0 on evenly, others by equal factors
  speed: ["m/s", 1, 0.05, 50], radius: ["mm", 1e-3, 5e-5, 0.01], thickness: ["mm", 1e-3, 5e-5, 0.1],
  mass: ["×", 1, 0.65, 5], angle: ["°", 1, 0, 85], friction: ["", 1, 0, 1] };
const asked = { speed: 2, radius: 1e-3, thickness: 2e-3, mass: 1, angle: 0, friction: 0.2 };
let hit, curves;
const round = (x, digits = 3) => Number(x.toPrecision(digits));
const place = ([low, high], x) => (low > 0 ? Math.log(x / low) / Math.log(high / low) : x / high);
const $min = (one, other) => other < one ? other : one; // what the kernels call beside Math
const $max = (one, other) => other > one ? other : one;
const $copysign = (x, sign) => sign < 0 || 1 / sign < 0 ? -Math.abs(x) : Math.abs(x);
const bounded = (x, low, high) => Math.min(Math.max(x, low), high);

for (const [id, [unit, size, low, high]] of Object.entries(SLIDERS)) {
  const row = document.createElement("div"), steps = low > 0 ? 1000 : high > 1 ? high : 100;
  row.innerHTML = `<label for="${id}">${id}</label>
    <input id="${id}" type="range" min="0" max="${steps}">
    <input type="number" min="0" step="any" aria-label="${id} ${unit}"> ${unit}`;
  byId("sliders").append(row);
  const [, slider, box] = row.children, endless = id === "thickness";
  if (endless) box.placeholder = "half-space";
  const set = (value, from) => {
    asked[id] = value;
    if (from !== slider) slider.value = steps * bounded(place([low, high], value), 0, 1);
    if (from !== box) box.value = value < Infinity ? round(value / size, 6) : "";
    slider.ariaValueText = value < Infinity ? `${round(value / size)} ${unit}` : "half-space";
    if (from) show();
  };
  slider.oninput = () => {
    const share = slider.value / steps;
    if (endless && share === 1) set(Infinity, slider);
    else set(low > 0 ? round(low * (high / low) ** share) : round(high * share, 2), slider);
  };
  box.oninput = () => {
    const value = endless && box.value === "" ? Infinity : round(parseFloat(box.value) * size, 12);
    const fits = value >= 0 && !box.validity.badInput && (id !== "angle" || value < 90);
    box.ariaInvalid = !fits;
    if (fits) set(value, box);
  };
  set(asked[id]);
}

function fill(id, entries) { // elements with texts
  byId(id).replaceChildren(...entries.map(([tag, text, more]) =>
    Object.assign(document.createElement(tag), { textContent: text }, more)));
}
function show() {
  const { speed, radius, thickness, mass, angle, friction } = asked;
  const tilt = Math.cos(angle * Math.PI / 180);
  const curve = ([, , low, high], at) => Array.from({ length: 73 }, (_, n) => {
    const x = low * (high / low) ** (n / 72), given = at(x), one = $for_curve(given);
    return [x, one.restitution, one.restitution >= 0 ? $exceeded(one, given) : 0];
  });
  curves = { speed: curve(SLIDERS.speed, (v) => ({ ...asked, speed: v * tilt })),
    thickness: curve(SLIDERS.thickness, (h) => ({ ...asked, speed: speed * tilt, thickness: h })) };
  hit = collide(asked);
  const outside = Object.keys(words).filter((bit) => !hit || hit.flags & bit);
  const said = !hit ? ["No answer: a number is out of range, or the plate is far too thin for this bead."]
    : outside.length ? outside.map((bit) => words[bit]) : ["Inside every limit of the model."];
  fill("flags", said.map((text) => ["li", text]));
  byId("flags").className = outside.length ? "outside" : "";
  byId("cor").textContent = hit ? hit.restitution.toFixed(4) : "–";
  const facts = {}, shares = {};
  if (hit) {
    Object.assign(facts, { "rebound speed": `${round(hit.restitution * hit.speed)} m/s`,
      "contact time": `${round(hit.contact_time * 1e6)} µs`, "peak force": `${round(hit.peak_force)} N`,
      "dent": `${round(hit.residual_compression * 1e6)} µm` });
    if (angle > 0) Object.assign(facts, { "along plate": `${round(hit.along)} m/s`,
      "spin": `${round(hit.spin)} rad/s` });
    const lost = { friction: hit.friction_share };
    for (const name of ["other", "plastic", "wave"])
      lost[name] = hit.normal_share * hit[`${name}_fraction`];
    shares.kept = Object.values(lost).reduce((left, share) => left - share, 1);
    for (const [name, share] of Object.entries(lost).reverse()) if (share > 0) shares[name] = share;
  }
  fill("facts", Object.entries(facts).flatMap(([name, value]) => [["dt", name], ["dd", value]]));
  fill("bar", Object.entries(shares).map(([name, share]) =>
    ["i", "", { style: `flex:${share};background:${ENERGIES[name][1]}` }]));
  fill("shares", Object.entries(shares).map(([name, share]) =>
    ["li", `${ENERGIES[name][0]} ${(100 * share).toFixed(1)} %`, { style: `border-color:${ENERGIES[name][1]}` }]));
  const python = thickness < Infinity ? thickness : "math.inf";
  const heavy = mass === 1 ? "" : `, mass=${round(mass * SOLID * radius ** 3, 9)}`;
  byId("python").textContent = `import math\nimport contactlaw as cl\n\nmodel = ${PYTHON}\n` + (angle > 0
    ? `angle = math.radians(${angle})\nhit = model.oblique(\n    speed=${speed} * math.cos(angle), `
      + `sliding_speed=${speed} * math.sin(angle),\n    radius=${radius}, thickness=${python}, `
      + `friction=${friction}, method="solve"${heavy},\n)`
    : `hit = model.solve(speed=${speed}, radius=${radius}, thickness=${python}${heavy})`)
    + "\nprint(hit.restitution, hit.flags)";
  redraws.forEach((redraw) => redraw());
}
function collide(given) { // null for what is refused
  const { impact, ...oblique } = $collide(given, given.angle, given.friction);
  return impact.restitution >= 0 ? { ...given, ...impact, ...oblique } : null;
}

// Axes of a chart, in the units of their labels.
function axes(pen, width, tall, across, up, titles) {
  const [x0, y0, x1, y1] = [46, tall - 44, width - 14, 28];
  const X = (v) => x0 + bounded(place(across, v), 0, 1) * (x1 - x0);
  const Y = (v) => y0 - place(up, v) * (y0 - y1);
  const marks = across[0] > 0 ? [-2, -1, 0, 1, 2].flatMap((n) => [1, 2, 5].map((k) => k * 10 ** n))
    .filter((v) => v >= across[0] && v <= across[1] * 1.001) : ticks(across[1]);
  const write = (text, x, y, align, base) => {
    [pen.textAlign, pen.textBaseline] = [align, base];
    pen.fillText(text, x, y);
  };
  pen.font = `${width < 420 ? 11 : 13}px ${FONT}`;
  [pen.fillStyle, pen.strokeStyle, pen.lineWidth] = [INK, LINE, 1];
  pen.beginPath();
  for (const v of ticks(up[1])) {
    pen.moveTo(x0, Y(v));
    pen.lineTo(x1, Y(v));
    write(round(v), x0 - 6, Y(v), "right", "middle");
  }
  pen.stroke();
  for (const v of marks) write(round(v), X(v), y0 + 6, "center", "top");
  write(titles[0], (x0 + x1) / 2, tall - 18, "center", "top");
  write(titles[1], 8, 6, "left", "top");
  [pen.strokeStyle, pen.lineWidth] = [BLUE, 2.5];
  return [X, Y];
}
function dot(pen, x, y) {
  circle(pen, x, y, 6);
  pen.fillStyle = RED;
  pen.fill();
}
const drawCurve = (id, title) => (pen, width, tall) => {
  const [, size, low, high] = SLIDERS[id];
  const [X, Y] = axes(pen, width, tall, [low / size, high / size], [0, 1], [title, "COR"]);
  for (const outside of [false, true]) {
    pen.setLineDash(outside ? [3, 4] : []);
    pen.beginPath();
    for (const [x, e, flags] of curves[id])
      pen[flags > 0 === outside ? "lineTo" : "moveTo"](X(x / size), Y(e));
    pen.stroke();
  }
  pen.setLineDash([]);
  if (hit) dot(pen, X(asked[id] / size), Y(hit.restitution));
};
function drawForce(pen, width, tall) {
  if (!hit) return;
  const path = $shown(hit, hit), end = path.time.at(-1) * 1e6;
  const [X, Y] = axes(pen, width, tall, [0, end], [0, Math.max(...path.force) * 1.08],
    ["time since touch [µs]", "contact force [N]"]);
  pen.beginPath();
  path.force.forEach((f, n) => pen.lineTo(X(path.time[n] * 1e6), Y(f)));
  pen.stroke();
}
const redraws = [];
show();
redraws.push(surface("over-speed", 0.56, drawCurve("speed", "speed of the bead [m/s]")),
  surface("over-thickness", 0.56, drawCurve("thickness", "thickness of the plate [mm]")),
  surface("force", 0.56, drawForce));
