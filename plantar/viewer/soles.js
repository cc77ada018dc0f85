// Soles and their forces on flat canvases, for the page of a recording and that of a stream.
const SOLES = (() => {
'use strict';
const VIRIDIS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]].map(c => c.map(v => v / 255));
const SIDES = ['left', 'right'];
const style = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function viridis(share) {
  const at = Math.min(Math.max(share, 0), 1) * (VIRIDIS.length - 1), low = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return VIRIDIS[low].map((v, i) => v + (at - low) * (VIRIDIS[low + 1][i] - v));
}

function flat(canvas) {
  const ratio = Math.min(devicePixelRatio, 2), width = canvas.clientWidth, height = canvas.clientHeight;
  const across = Math.round(width * ratio), down = Math.round(height * ratio), pen = canvas.getContext('2d');
  if (canvas.width !== across || canvas.height !== down) { canvas.width = across; canvas.height = down; }  // takes new memory
  else pen.reset();
  pen.scale(ratio, ratio);
  return {pen, width, height};
}

// Both soles from above, toes up: x of the sole is up, y to the left. `full`: force in N of the brightest cell.
// `walk.under`, where it is there, draws on a sole at picture i below its CoP. Returns what finds the taxel at a point of the canvas.
function drawSoles(walk, canvas, i, full) {
  const {pen, width, height} = flat(canvas);
  const all = SIDES.filter(s => walk.soles[s]), outlines = all.flatMap(s => walk.soles[s].outline);
  const [low, high] = [Math.min, Math.max].map(f => [f(...outlines.map(p => p[0])), f(...outlines.map(p => p[1]))]);
  const column = width / all.length;
  const scale = 0.9 * Math.min(height / (high[0] - low[0]), column / (high[1] - low[1]));
  all.forEach((side, n) => {
    const sole = walk.soles[side];
    const put = p => [column * (n + 0.5) - scale * (p[1] - (low[1] + high[1]) / 2), height / 2 - scale * (p[0] - (low[0] + high[0]) / 2)];
    const ring = points => { pen.beginPath(); points.forEach((p, k) => pen[k ? 'lineTo' : 'moveTo'](...put(p))); pen.closePath(); };
    sole.cells.forEach((cell, taxel) => {
      const force = walk.force(side, taxel, i);
      pen.fillStyle = Number.isNaN(force) ? '#888888' : `rgb(${viridis(force / full).map(v => Math.round(255 * v))})`;
      ring(cell);
      pen.fill();
    });
    pen.strokeStyle = style('--soft');
    ring(sole.outline);
    pen.stroke();
    if (walk.under) walk.under(side, pen, put, ring, i);
    const cop = walk.cop(side, i);
    if (!cop) return;
    const [x, y] = put(cop);
    for (const [line, colour] of [[5, '#ffffff'], [2.5, style('--cop')]]) {
      pen.lineWidth = line; pen.strokeStyle = colour;
      pen.beginPath(); pen.moveTo(x - 8, y); pen.lineTo(x + 8, y); pen.moveTo(x, y - 8); pen.lineTo(x, y + 8); pen.stroke();
    }
    pen.lineWidth = 1;
  });
  drawLength(pen, scale, height);
  return (left, top) => {
    const n = Math.floor(left / column), side = all[n];
    if (!side) return null;
    const x = (low[0] + high[0]) / 2 - (top - height / 2) / scale, y = (low[1] + high[1]) / 2 - (left - column * (n + 0.5)) / scale;
    const taxel = walk.soles[side].cells.findIndex(cell => contains(cell, x, y));
    return taxel < 0 ? null : {side, taxel};
  };
}

// A line of 5 cm, which gives the soles their size.
function drawLength(pen, scale, height) {
  pen.strokeStyle = style('--soft'); pen.fillStyle = style('--soft'); pen.font = '12px system-ui, sans-serif';
  pen.beginPath();
  pen.moveTo(6, height - 10); pen.lineTo(6, height - 6); pen.lineTo(6 + 0.05 * scale, height - 6); pen.lineTo(6 + 0.05 * scale, height - 10);
  pen.stroke();
  pen.fillText('5 cm', 6, height - 14);
}

function contains(cell, x, y) {
  return cell.every((a, k) => {
    const b = cell[(k + 1) % cell.length];
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0;
  });
}

// The round number, 1, 2 or 5 times a power of ten, that is at least so much.
function nice(least) {
  const power = 10 ** Math.floor(Math.log10(Math.max(least, 1e-9)));
  return power * [1, 2, 5, 10].find(k => k * power >= least * (1 - 1e-9));
}

function drawForces(walk, canvas, time, end, unit = 'N') {
  const {pen, width, height} = flat(canvas), times = walk.time, most = Math.max(...SIDES.map(s => walk.totals[s] ? walk.totals[s].reduce((a, b) => Math.max(a, b || 1), 1) : 1));
  const x = t => width * t / Math.max(end, 1e-6), y = f => height - 16 - (height - 28) * f / most;
  pen.font = '12px system-ui, sans-serif';
  pen.strokeStyle = style('--line');
  pen.fillStyle = style('--soft');
  const marks = [];
  for (let f = 0, by = nice(most / 4.5); f <= most; f += by) {
    pen.beginPath(); pen.moveTo(0, y(f)); pen.lineTo(width, y(f)); pen.stroke();
    marks.push([f ? f + ' ' + unit : '', 4, y(f) - 3]);
  }
  for (let t = 0, by = nice(60 * end / width); t <= end; t += by) marks.push([Number(t.toFixed(3)) + ' s', x(t) + 3, height - 3]);
  for (const side of SIDES) {
    const total = walk.totals[side];
    if (!total) continue;
    const step = Math.max(1, Math.floor(total.length / (2 * width)));
    pen.strokeStyle = style('--' + side);
    pen.beginPath();
    let on = false;
    for (let i = 0; i < total.length; i += step) {
      if (!Number.isNaN(total[i])) pen[on ? 'lineTo' : 'moveTo'](x(times[i]), y(total[i]));
      on = !Number.isNaN(total[i]);
    }
    pen.stroke();
  }
  for (const [text, left, low] of marks) pen.fillText(text, left, low);
  pen.strokeStyle = style('--ink');
  pen.beginPath(); pen.moveTo(x(time), 0); pen.lineTo(x(time), height); pen.stroke();
}

return {SIDES, style, viridis, drawSoles, drawForces};
})();
