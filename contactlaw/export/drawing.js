"use strict";
// What the pages of contactlaw draw with.
const byId = (id) => document.getElementById(id);
const INK = "#222", LINE = "#e2e2e2", BLUE = "#0072b2", RED = "#d55e00";
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
