// Shows a stream as it comes: one state at a time, the newest; drawn when the screen is.
(() => {
'use strict';
const {SIDES, style, drawSoles, drawForces} = SOLES;
const $ = id => document.getElementById(id);
const SECONDS = 10, TRAIL = 2;  // of forces, and of the CoP
const POINT = 0.015;  // s between points
const given = JSON.parse($('data').textContent);

// What the drawings of a recording read, filled by a stream.
class Stream {
  constructor(soles) {
    this.soles = soles;
    this.times = [];
    this.sums = Object.fromEntries(Object.keys(soles).map(side => [side, []]));
    this.trails = Object.fromEntries(Object.keys(soles).map(side => [side, []]));
    this.state = {soles: {}};
  }
  take(state) {
    if (this.times.length && state.time < this.times[this.times.length - 1]) this.times = [];
    if (!this.times.length) for (const side of Object.keys(this.soles)) { this.sums[side] = []; this.trails[side] = []; }
    this.state = state;
    // States that share a picture are one point of the lines.
    const known = this.times.length > 1 && state.time - this.times[this.times.length - 2] < POINT;
    if (known) for (const kept of [this.times, ...Object.values(this.sums), ...Object.values(this.trails)]) kept.pop();
    this.times.push(state.time);
    for (const side of Object.keys(this.soles)) {
      const sole = state.soles[side];
      this.sums[side].push(sole && sole.load !== null ? sole.load : NaN);
      this.trails[side].push(sole && sole.cop);
    }
    while (this.times[0] < state.time - SECONDS) {
      this.times.shift();
      for (const side of Object.keys(this.soles)) { this.sums[side].shift(); this.trails[side].shift(); }
    }
  }
  get time() { const begin = this.state.time - SECONDS; return this.times.map(t => t - begin); }
  get totals() { return this.sums; }
  force(side, taxel) {
    const sole = this.state.soles[side], value = sole ? sole.force[taxel] : null;
    return value === null ? NaN : value / 10;
  }
  cop(side) { const sole = this.state.soles[side]; return sole ? sole.cop : null; }
  under(side, pen, put, ring) {
    const sole = this.state.soles[side];
    if (!sole) return;
    pen.strokeStyle = '#1a9850'; pen.lineWidth = 2;
    if (sole.polygon.length > 2) { ring(sole.polygon); pen.stroke(); }
    pen.lineWidth = 1.5; pen.strokeStyle = '#ffffff';
    pen.beginPath();
    let on = false;
    this.trails[side].forEach((place, k) => {
      if (this.times[k] < this.state.time - TRAIL) return;
      if (place) pen[on ? 'lineTo' : 'moveTo'](...put(place));
      on = Boolean(place);
    });
    pen.stroke();
    pen.strokeStyle = style('--cop'); pen.lineWidth = 1; pen.stroke();
  }
}

for (const place of document.querySelectorAll('.unit')) place.textContent = given.unit;
const stream = new Stream(given.soles);
window.latencies = [];
let waiting = false, full = 20, locate = null, chosen = null, over = false, sound = null;

// Writes a text that has changed: each writing lays the page out again.
function write(id, text) { if ($(id).textContent !== text) $(id).textContent = text; }

function draw() {
  waiting = false;
  const state = stream.state;
  if (!stream.times.length) return;
  for (const side of SIDES) if (state.soles[side]) full = Math.max(full, ...state.soles[side].force.map(v => (v || 0) / 10));
  locate = drawSoles(stream, $('soles'), 0, full);
  drawForces(stream, $('forces'), SECONDS, SECONDS, given.unit);
  write('full', full.toFixed(0));
  write('status', state.status);
  if (chosen) {
    const force = stream.force(chosen.side, chosen.taxel), id = given.soles[chosen.side].ids[chosen.taxel];
    write('taxel', `Taxel ${id}, ${chosen.side}: ${Number.isNaN(force) ? 'not measured' : force.toFixed(1) + ' ' + given.unit}.`);
  }
  showMeasures(state.measures);
  showLog(state.log);
  feedback(state);
  if ($('record').ariaPressed !== String(state.recording)) $('record').ariaPressed = String(state.recording);
  write('record', state.recording ? 'Recording' : 'Record');
  latencies.push(Date.now() - state.arrived);
  if (latencies.length > 3000) latencies.shift();
  document.body.dataset.ready ||= 'true';
}

function showMeasures(rows) {
  const body = $('measures');
  while (body.rows.length < rows.length) {
    const row = body.insertRow(), head = document.createElement('th');
    head.scope = 'row';
    row.append(head, document.createElement('td'), document.createElement('td'));
  }
  rows.forEach((texts, k) => texts.forEach((text, n) => {
    const cell = body.rows[k].cells[n];
    if (cell.textContent !== text) cell.textContent = text;
  }));
}

let logged = '';
function showLog(lines) {
  const text = lines.join('\n');
  if (text === logged) return;
  logged = text;
  $('log').replaceChildren(...lines.map(line => { const item = document.createElement('li'); item.textContent = line; return item; }));
}

function feedback(state) {
  const limit = Number($('limit').value), set = $('limit').value !== '' && limit > 0;
  const above = set ? SIDES.filter(side => state.soles[side] && state.soles[side].load > limit) : [];
  const text = above.length ? `More than ${limit} ${given.unit} on the ${above.join(' and the ')} sole` : '';
  write('alarm', text);
  if (above.length && !over && $('sound').checked) beep();
  over = above.length > 0;
}

function beep() {
  sound = sound || new AudioContext();
  const tone = sound.createOscillator(), volume = sound.createGain();
  tone.frequency.value = 880; volume.gain.value = 0.2;
  tone.connect(volume).connect(sound.destination);
  tone.start(); tone.stop(sound.currentTime + 0.12);
}

function act(what) {
  fetch('do', {method: 'POST', headers: {'X-Plantar': given.token, 'Content-Type': 'application/json'}, body: JSON.stringify({do: what})})
    .catch(() => { $('status').textContent = 'The stream has ended.'; });
}

for (const id of ['zero', 'mark', 'record']) $(id).addEventListener('click', () => act(id));
$('sound').addEventListener('change', () => { if ($('sound').checked) beep(); });
$('soles').addEventListener('click', e => { chosen = locate ? locate(e.offsetX, e.offsetY) : null; });
const source = new EventSource('stream?token=' + given.token);
source.addEventListener('message', e => {
  stream.take(JSON.parse(e.data));
  if (!waiting) { waiting = true; requestAnimationFrame(draw); }
});
source.addEventListener('error', () => { $('status').textContent = 'No connection: the stream has ended, or begins again.'; });
new ResizeObserver(draw).observe($('live'));
})();
