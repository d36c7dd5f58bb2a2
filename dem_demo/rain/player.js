// All quantities are in metres and seconds; only the drawing functions use pixels.
const still = matchMedia("(prefers-reduced-motion: reduce)").matches, MUTED = "#a9a9a9";
const data = JSON.parse(document.getElementById("data").textContent);

function unpack(text, fields) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const numbers = new Float32Array(bytes.buffer), found = [];
  for (let n = 0; n < numbers.length; n += fields.length)
    found.push(Object.fromEntries(fields.map((name, k) => [name, numbers[n + k]])));
  return found;
}

// The rain.
const pieces = unpack(data.pieces, data.fields);
const [left, right, bottom, top_] = data.window;
const [low, high] = data.range;
let now = 0, playing = !still;

function colour(restitution) {
  if (!(restitution >= 0)) return MUTED;
  const share = Math.min(1, Math.max(0, (restitution - low) / (high - low)));
  return data.colours[Math.round(share * (data.colours.length - 1))];
}

function height(piece, speed, age) {
  return piece.y + speed * age - 0.5 * piece.fall * age * age;
}

function drawRain(pen, width, tall) {
  const scale = width / (right - left);
  const X = (x) => (x - left) * scale, Y = (y) => tall - (y - bottom) * scale;
  pen.textAlign = "center";
  pen.textBaseline = "top";
  const size = Math.min(15, Math.max(10, width / 42));
  pen.font = "600 " + size + "px " + FONT;
  for (const plate of data.plates) {
    pen.fillStyle = INK;
    pen.fillRect(X(plate.x0), Y(plate.y), (plate.x1 - plate.x0) * scale, Math.max(1, plate.depth * scale));
    pen.fillText(plate.label, X((plate.x0 + plate.x1) / 2), Y(plate.y - plate.depth) + 4);
  }
  for (const piece of pieces) {
    if (!(piece.start <= now && now < piece.end)) continue;
    const age = now - piece.start, before = Math.max(0, age - data.exposure);
    const x = X(piece.x + piece.u * age), y = Y(height(piece, piece.v, age));
    const radius = Math.max(2, data.magnified * piece.radius * scale);
    pen.strokeStyle = pen.fillStyle = colour(piece.restitution);
    pen.globalAlpha = 0.45;
    pen.lineWidth = Math.max(1, 0.6 * radius);
    pen.beginPath();
    pen.moveTo(X(piece.x + piece.u * before), Y(height(piece, piece.v, before)));
    pen.lineTo(x, y);
    pen.stroke();
    pen.globalAlpha = 1;
    circle(pen, x, y, radius);
    pen.fill();
    if (piece.outside) {
      pen.strokeStyle = RED;
      pen.lineWidth = 1.5;
      pen.stroke();
    }
    if (piece.spin !== undefined) {
      const angle = (piece.angle + piece.spin * age) / data.turning, reach = data.hand * radius;
      pen.strokeStyle = INK;
      pen.lineWidth = 1.5;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + reach * Math.cos(angle), y - reach * Math.sin(angle));
      pen.stroke();
    }
    if (byId("others").checked && piece.other_v >= 0) {
      const other = height(piece, piece.other_v, age);
      if (other < piece.y) continue; // the bead would have fallen back by now
      pen.strokeStyle = INK;
      pen.lineWidth = 1.2;
      circle(pen, x, Y(other), radius + 1);
      pen.stroke();
      pen.globalAlpha = 0.4;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x, Y(other));
      pen.stroke();
      pen.globalAlpha = 1;
    }
  }
  byId("clock").textContent = (now * 1e3).toFixed(0) + " ms";
}

// One hit: motion of bead and plate, and contact force.
// 1 - (2/pi) Si(s): how the answer of a thin infinite plate to a tap spreads, s = r^2/(4 spread t).
const SPREAD = (() => {
  const step = 0.05, table = [1];
  const sinc = (s) => (s ? Math.sin(s) / s : 1);
  for (let s = 0; s < 60; s += step)
    table.push(table[table.length - 1] - (2 / Math.PI) * step * sinc(s + step / 2));
  return (s) => (s < 60 ? table[Math.round(s / step)] : 0);
})();

function sampled(values, time) {
  const place = Math.min(1, Math.max(0, time)) * (values.length - 1), n = Math.floor(place);
  return n + 1 < values.length ? values[n] + (place - n) * (values[n + 1] - values[n]) : values[n];
}

// Displacement of the plate at a distance from the contact, at a time in contact times.
function deflection(one, distance, time) {
  const BINS = 24;
  let sum = 0;
  for (let k = 0; k < BINS && k < time * BINS; k++) {
    const part = sampled(one.displacement, (k + 1) / BINS) - sampled(one.displacement, k / BINS);
    const age = Math.max(1e-3, time - (k + 0.5) / BINS) * one.duration;
    sum += part * SPREAD((distance * distance) / (4 * one.spread * age));
  }
  return sum;
}

const hits = data.hits;
const BEFORE = 0.7, AFTER = 2.6, LOOP = 6; // contact times before and after touch; seconds
let hit = hits[0], phase = still ? 0.5 : -BEFORE; // in contact times

const most = Math.max(...hits.map((one) =>
  Math.max(...one.compression.map((c, n) => (c + one.displacement[n]) / one.radius))));
const EXAGGERATED = Math.max(1, Math.round(0.35 / most));

// Bead and plate to scale, what moves EXAGGERATED times larger.
function drawContact(pen, width, tall) {
  const scale = width / (11 * hit.radius), radius = hit.radius * scale, ground = 0.62 * tall;
  const shift = (metres) => metres * scale * EXAGGERATED;
  const depth = Math.min(hit.thickness * scale, 0.5 * tall);
  const surfaceAt = (x) => ground + shift(deflection(hit, Math.abs(x - width / 2) / scale, phase));
  pen.beginPath();
  for (let x = -3; x <= width + 3; x += 3) pen.lineTo(x, surfaceAt(x));
  for (let x = width + 3; x >= -3; x -= 3) pen.lineTo(x, surfaceAt(x) + depth);
  pen.fillStyle = "#cfd8dc";
  pen.fill();
  let gap = 0;
  if (phase < 0) gap = -phase * hit.duration * hit.speed;
  if (phase > 1) gap = (phase - 1) * hit.duration * hit.speed * hit.model - hit.compression.at(-1);
  const pressed = phase >= 0 && phase <= 1 ? sampled(hit.compression, phase) : 0;
  const sunk = phase < 0 ? 0 : pressed + sampled(hit.displacement, phase);
  pen.save();
  if (phase >= 0 && phase <= 1) { // the bead is flattened at the contact
    pen.beginPath();
    pen.rect(0, 0, width, surfaceAt(width / 2));
    pen.clip();
  }
  circle(pen, width / 2, ground - radius - shift(gap) + shift(sunk), radius);
  pen.fillStyle = colour(phase < 0 ? NaN : hit.model);
  pen.fill();
  pen.restore();
  pen.fillStyle = INK;
  pen.textAlign = "left";
  pen.textBaseline = "top";
  pen.font = "14px " + FONT;
  pen.fillText((phase * hit.duration * 1e6).toFixed(1) + " µs", 10, 10);
}

function drawForce(pen, width, tall) {
  const peak = Math.max(...hits.map((one) => Math.max(...one.force))) * 1.08;
  const last = Math.max(...hits.map((one) => one.duration)) * 1.05;
  const [x0, y0, x1, y1] = [44, tall - 42, width - 12, 26];
  const X = (t) => x0 + (t / last) * (x1 - x0), Y = (f) => y0 - (f / peak) * (y0 - y1);
  pen.font = "13px " + FONT;
  pen.fillStyle = INK;
  pen.lineWidth = 1;
  pen.textBaseline = "middle";
  pen.textAlign = "right";
  for (const f of ticks(peak)) {
    pen.strokeStyle = LINE;
    pen.beginPath();
    pen.moveTo(x0, Y(f));
    pen.lineTo(x1, Y(f));
    pen.stroke();
    pen.fillText(+f.toPrecision(3), x0 - 6, Y(f));
  }
  pen.textAlign = "center";
  pen.textBaseline = "top";
  for (const t of ticks(last * 1e6)) pen.fillText(+t.toPrecision(3), X(t * 1e-6), y0 + 5);
  pen.fillText("time since touch [µs]", (x0 + x1) / 2, tall - 19);
  pen.textAlign = "left";
  pen.fillText("contact force [N]", 8, 6);
  const curve = (one, until) => {
    pen.beginPath();
    for (let k = 0; k <= 100 && k <= until * 100; k++)
      pen.lineTo(X((k / 100) * one.duration), Y(sampled(one.force, k / 100)));
    pen.stroke();
  };
  for (const one of hits) {
    pen.strokeStyle = one === hit ? "#f3c7a8" : "#d5d5d5";
    pen.lineWidth = one === hit ? 3 : 1.5;
    curve(one, 1);
  }
  const until = Math.min(1, Math.max(0, phase));
  pen.strokeStyle = pen.fillStyle = RED;
  pen.lineWidth = 3;
  curve(hit, until);
  circle(pen, X(until * hit.duration), Y(sampled(hit.force, until)), 5);
  pen.fill();
}

function choose(one, button) {
  hit = one;
  phase = still ? 0.5 : -BEFORE;
  for (const other of byId("plates").children) other.ariaPressed = other === button;
  const back = (restitution) => (restitution * one.speed).toFixed(2) + " m/s";
  byId("hit").textContent =
    "The hardest hit on the plate of " + one.label + ": a bead of radius " +
    (one.radius * 1e3).toFixed(2) + " mm comes at " + one.speed.toFixed(2) +
    " m/s, presses for " + (one.duration * 1e6).toFixed(1) + " µs with up to " +
    Math.max(...one.force).toFixed(1) + " N, and leaves at " + back(one.model) + ": COR " +
    one.model.toFixed(3) + ". A constant COR of " + one.constant.toFixed(2) + " sends it back at " +
    back(one.constant) + ".";
}

byId("low").textContent = low.toFixed(2);
byId("high").textContent = high.toFixed(2);
byId("scale").style.background = "linear-gradient(to right, " + data.colours.join(", ") + ")";
const redraws = [surface("rain", (top_ - bottom) / (right - left), drawRain)];
if (hits.length) {
  for (const one of hits) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = one.label;
    button.onclick = () => { choose(one, button); redraws.forEach((redraw) => redraw()); };
    byId("plates").append(button);
  }
  const first = byId("plates").children[0];
  choose(hits[0], first);
  byId("exaggerated").textContent = EXAGGERATED;
  redraws.push(surface("contact", 0.62, drawContact), surface("force", 0.62, drawForce));
} else {
  byId("plates").closest("section").hidden = true;
}

function show() {
  byId("play").textContent = playing ? "Pause" : "Play";
}
byId("play").onclick = () => { playing = !playing; show(); };
byId("scrub").oninput = (event) => {
  now = (event.target.value / 1000) * data.duration;
  redraws.forEach((redraw) => redraw());
};
byId("others").onchange = () => redraws[0]();
show();

let last = null;
function step(time) {
  const passed = last === null ? 0 : Math.min(0.1, (time - last) / 1e3);
  last = time;
  if (playing && data.duration > 0) {
    now = (now + passed / byId("slower").value) % data.duration;
    byId("scrub").value = (now / data.duration) * 1000;
    phase += (passed * (BEFORE + AFTER)) / LOOP;
    if (phase > AFTER) phase = -BEFORE;
    redraws.forEach((redraw) => redraw());
  }
  requestAnimationFrame(step);
}
requestAnimationFrame(step);
