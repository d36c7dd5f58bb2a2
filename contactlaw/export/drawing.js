"use strict";
// What the pages of contactlaw draw with. All quantities are in metres and seconds; only the
// drawing functions use pixels.
const byId = (id) => document.getElementById(id);
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
const INK = "#222", MUTED = "#a9a9a9", LINE = "#e2e2e2", BLUE = "#0072b2", RED = "#d55e00";
const FONT = "system-ui, sans-serif";

// A canvas of the page's width and a given height, drawn in CSS pixels.
function surface(id, aspect, draw) {
  const canvas = byId(id), pen = canvas.getContext("2d");
  const fit = () => {
    const width = canvas.clientWidth, height = Math.round(width * aspect);
    canvas.style.height = height + "px";
    canvas.width = Math.round(width * devicePixelRatio);
    canvas.height = Math.round(height * devicePixelRatio);
    redraw();
  };
  const redraw = () => {
    pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    const width = canvas.width / devicePixelRatio, height = canvas.height / devicePixelRatio;
    pen.clearRect(0, 0, width, height);
    draw(pen, width, height);
  };
  new ResizeObserver(fit).observe(canvas.parentElement);
  fit();
  return redraw;
}

function circle(pen, x, y, radius) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
}

function ticks(most) {
  const raw = most / 5, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((n) => n * power).find((n) => n >= raw), found = [];
  for (let value = 0; value <= most; value += step) found.push(value);
  return found;
}

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

// Bead and plate to scale at a time in contact times, what moves `larger` times larger. A bead that
// slides has its speeds along the plate before and after, and its spin after.
function drawHit(pen, width, tall, hit, phase, larger, colour) {
  const scale = width / (11 * hit.radius), radius = hit.radius * scale, ground = 0.62 * tall;
  const shift = (metres) => metres * scale * larger;
  const depth = Math.min(hit.thickness * scale, 0.5 * tall);
  const surfaceAt = (x) => ground + shift(deflection(hit, Math.abs(x - width / 2) / scale, phase));
  pen.beginPath();
  for (let x = -3; x <= width + 3; x += 3) pen.lineTo(x, surfaceAt(x));
  for (let x = width + 3; x >= -3; x -= 3) pen.lineTo(x, surfaceAt(x) + depth);
  pen.closePath();
  pen.fillStyle = "#cfd8dc";
  pen.fill();
  let gap = 0;
  if (phase < 0) gap = -phase * hit.duration * hit.speed;
  if (phase > 1) gap = (phase - 1) * hit.duration * hit.speed * hit.model - hit.compression.at(-1);
  const pressed = phase >= 0 && phase <= 1 ? sampled(hit.compression, phase) : 0;
  const sunk = phase < 0 ? 0 : pressed + sampled(hit.displacement, phase);
  const y = ground - radius - shift(gap) + shift(sunk);
  // along the plate, at a speed that changes evenly during the contact
  const [before, t, after] = [Math.min(phase, 0), Math.min(Math.max(phase, 0), 1), Math.max(phase - 1, 0)];
  const moved = (first, last) => shift(hit.duration
    * ((before + t) * first + 0.5 * t * t * (last - first) + after * last));
  const x = width / 2 + moved(hit.size || 0, hit.along || 0);
  pen.save();
  if (phase >= 0 && phase <= 1) { // the bead is flattened at the contact
    pen.beginPath();
    pen.rect(0, 0, width, surfaceAt(width / 2));
    pen.clip();
  }
  circle(pen, x, y, radius);
  pen.fillStyle = colour;
  pen.fill();
  if (hit.spin !== undefined) { // a line that turns with the bead
    const angle = moved(0, hit.spin) / scale;
    pen.strokeStyle = "#fff";
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x + 0.9 * radius * Math.sin(angle), y - 0.9 * radius * Math.cos(angle));
    pen.stroke();
  }
  pen.restore();
  pen.fillStyle = INK;
  pen.textAlign = "left";
  pen.textBaseline = "top";
  pen.font = "14px " + FONT;
  pen.fillText((phase * hit.duration * 1e6).toFixed(1) + " µs", 10, 10);
}
