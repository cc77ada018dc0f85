// Shows the walks of the page: in 3D, on the soles, over time. Everything is drawn for one time, when that changes.
(() => {
'use strict';
const {SIDES, style, viridis, drawSoles, drawForces} = SOLES;
const $ = id => document.getElementById(id);
const NOT_MEASURED = 0xFFFF, ARROW = 0.4, CORNERS = 12;  // ARROW: m that stand for the weight
const BELOW = 0.99, SAMPLES = 2e5, LOADED = 1;  // the colours' end: so large a share of readings above LOADED N is below it
const SEEN = {corner: [-0.9, 0.3], side: [-Math.PI / 2, 0.12], front: [0, 0.12], above: [-Math.PI / 2, 1.5],
  below: [-Math.PI / 2, -1.3]};  // azimuth and elevation in rad of the eye

function unpack(text, type) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new type(bytes.buffer);
}

// A walk's numbers, and what they are at a time.
class Walk {
  constructor(given) {
    Object.assign(this, given);
    this.time = unpack(given.time, Float32Array);
    this.poses = unpack(given.poses, Float32Array);
    this.zmp = unpack(given.zmp, Float32Array);
    this.polygon = unpack(given.polygon, Float32Array);
    this.totals = {};
    for (const side of SIDES) {
      const sole = this.soles[side];
      if (!sole) continue;
      sole.force = sole.force ? unpack(sole.force, Float32Array)
        : Float32Array.from(unpack(sole.decinewtons, Uint16Array), v => v === NOT_MEASURED ? NaN : v / 10);
      this.totals[side] = unpack(sole.total, Float32Array);
      sole.cop = unpack(sole.cop, Float32Array);
      sole.active = unpack(sole.active, Uint8Array);
      if (sole.near) sole.near = unpack(sole.near, Float32Array);
    }
  }
  // Force in N below which nearly all loaded readings are: one spike does not darken all others.
  usual() {
    const all = SIDES.filter(s => this.soles[s]).map(s => this.soles[s].force);
    const step = Math.max(1, Math.floor(all.reduce((n, forces) => n + forces.length, 0) / SAMPLES));
    const found = [];
    for (const forces of all) for (let k = 0; k < forces.length; k += step) if (forces[k] > LOADED) found.push(forces[k]);
    const sorted = Float32Array.from(found).sort();
    return sorted.length ? Math.max(1, Math.ceil(sorted[Math.floor(BELOW * (sorted.length - 1))])) : 1;
  }
  get duration() { return this.time[this.time.length - 1]; }
  index(time) {
    let low = 0, high = this.time.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time[middle] <= time + 1e-6) low = middle; else high = middle - 1;
    }
    return low;
  }
  // Position and quaternion of a frame between two pictures.
  pose(frame, time, place, turn) {
    const i = this.index(time), j = Math.min(i + 1, this.time.length - 1), span = this.time[j] - this.time[i];
    const share = span > 0 ? Math.min(Math.max((time - this.time[i]) / span, 0), 1) : 0;
    const a = 7 * (i * this.frames.length + frame), b = 7 * (j * this.frames.length + frame), p = this.poses;
    place.set(p[a], p[a + 1], p[a + 2]).lerp(new THREE.Vector3(p[b], p[b + 1], p[b + 2]), share);
    turn.set(p[a + 3], p[a + 4], p[a + 5], p[a + 6]);
    turn.slerp(new THREE.Quaternion(p[b + 3], p[b + 4], p[b + 5], p[b + 6]), share);
  }
  force(side, taxel, i) {
    const sole = this.soles[side];
    return sole.force[i * sole.cells.length + taxel];
  }
  cop(side, i) {
    const cop = this.soles[side].cop.subarray(2 * i, 2 * i + 2);
    return Number.isNaN(cop[0]) ? null : cop;
  }
  // Cells of the loaded taxels of a sole at picture i.
  loaded(side, i) {
    const {cells, active} = this.soles[side];
    return cells.filter((_, k) => { const bit = i * cells.length + k; return active[bit >> 3] & (128 >> (bit & 7)); });
  }
  under(side, pen, put, ring, i) {
    const cells = this.loaded(side, i);
    if (!cells.length) return;
    pen.lineWidth = 2;
    pen.strokeStyle = style('--concave');
    pen.beginPath();
    for (const [a, b] of rim(cells)) { pen.moveTo(...put(a)); pen.lineTo(...put(b)); }
    pen.stroke();
    pen.strokeStyle = style('--convex');
    ring(hull(cells.flat()));
    pen.stroke();
    pen.lineWidth = 1;
  }
  // What a sole perceives at picture i, as the words of a row.
  perceived(side, i) {
    const sole = this.soles[side], cells = this.loaded(side, i), cop = this.cop(side, i), total = this.totals[side][i];
    const cm2 = polygon => 1e4 * Math.abs(twice(polygon)) / 2;
    const words = [side, force(total), `${cells.length} of ${sole.cells.length}`,
      cop ? `${rounded(1e3 * cop[0])}, ${rounded(1e3 * cop[1])} mm` : 'none',
      cop ? `${rounded(total * cop[1], 1)}, ${rounded(-total * cop[0], 1)} N m` : 'none',
      `${rounded(cells.length ? cm2(hull(cells.flat())) : 0)} cm²`,
      `${rounded(cells.reduce((sum, cell) => sum + cm2(cell), 0))} cm²`];
    const sensed = SIDES.some(s => this.soles[s] && this.soles[s].near);
    if (sensed) words.push(sole.near && !Number.isNaN(sole.near[i]) ? `${rounded(Math.max(sole.near[i], 0))} mm` : 'not sensed');
    return words;
  }
}

const force = total => Number.isNaN(total) ? 'not measured' : total.toFixed(0) + ' N';

const rounded = (value, digits = 0) => value.toFixed(digits).replace(/^-(0(\.0+)?)$/, '$1');

// Twice the area of a polygon, positive where it goes round to the left.
function twice(polygon) {
  return polygon.reduce((sum, a, k) => { const b = polygon[(k + 1) % polygon.length]; return sum + a[0] * b[1] - a[1] * b[0]; }, 0);
}

// Convex hull of points: Andrew's monotone chain.
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]), sides = [];
  for (const order of [sorted, [...sorted].reverse()]) {
    const chain = [];
    for (const p of order) {
      while (chain.length > 1 && twice([chain.at(-2), chain.at(-1), p]) <= 1e-15) chain.pop();
      chain.push(p);
    }
    sides.push(...chain.slice(0, -1));
  }
  return sides;
}

// Edges that only one of the cells has.
function rim(cells) {
  const edges = new Map();
  for (const cell of cells)
    cell.forEach((a, k) => {
      const b = cell[(k + 1) % cell.length], name = [a.join(), b.join()].sort().join(' ');
      edges.set(name, edges.has(name) ? null : [a, b]);
    });
  return [...edges.values()].filter(Boolean);
}

function meshOf(shape) {
  const [r, g, b, a] = shape.colour, size = shape.size;
  const material = new THREE.MeshStandardMaterial({color: new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace),
    opacity: a, transparent: a < 1, roughness: 0.75, metalness: 0.05});
  let mesh;
  if (shape.kind === 'cube') mesh = new THREE.Mesh(new THREE.BoxGeometry(...size), material);
  else if (shape.kind === 'sphere') {
    mesh = new THREE.Mesh(new THREE.SphereGeometry(0.5, 24, 16), material);
    mesh.scale.set(...size);
  } else if (shape.kind === 'cylinder') {
    const tube = new THREE.CylinderGeometry(0.5, 0.5, 1, 24);
    tube.rotateX(Math.PI / 2);  // three's lies along y
    mesh = new THREE.Mesh(tube, material);
    mesh.scale.set(...size);
  } else if (shape.kind === 'triangles') {
    const corners = new THREE.BufferGeometry();
    corners.setAttribute('position', new THREE.BufferAttribute(unpack(shape.points, Float32Array), 3));
    corners.setIndex(new THREE.BufferAttribute(unpack(shape.indices, Uint32Array), 1));
    const flat = corners.toNonIndexed();
    flat.computeVertexNormals();
    material.side = THREE.DoubleSide;
    return new THREE.Mesh(flat, material);
  } else if (shape.kind === 'line') {
    const points = new THREE.BufferGeometry();
    points.setAttribute('position', new THREE.BufferAttribute(unpack(shape.points, Float32Array), 3));
    return new THREE.LineLoop(points, new THREE.LineBasicMaterial({color: new THREE.Color(r, g, b)}));
  } else return null;
  mesh.position.set(...shape.pose.slice(0, 3));
  mesh.quaternion.set(...shape.pose.slice(3));
  return mesh;
}

// Lines along x and y up to half a size about the origin, in short pieces: software renderers lose those that begin
// behind the eye.
function gridOf(half, pitch) {
  const at = [], n = Math.round(half / pitch);
  for (let i = -n; i <= n; i++)
    for (let j = -n; j < n; j++) {
      const [a, b, c] = [i * pitch, j * pitch, (j + 1) * pitch];
      at.push(a, b, 0, a, c, 0, b, a, 0, c, a, 0);
    }
  const points = new THREE.BufferGeometry().setAttribute('position', new THREE.Float32BufferAttribute(at, 3));
  return new THREE.LineSegments(points, new THREE.LineBasicMaterial());
}

// What lies inside the robot, such as the soles in its shoes, is drawn over it.
const over = options => ({depthTest: false, depthWrite: false, transparent: true, ...options});

class Space {
  constructor(walk, canvas, eye) {
    this.walk = walk;
    this.canvas = canvas;
    this.eye = eye;
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});  // to be saved and printed
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.1, 100);
    this.camera.up.set(0, 0, 1);
    this.target = new THREE.Vector3();
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8890a0, 2.1));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(-1, -2, 4);
    this.scene.add(sun);
    this.groups = {robot: new THREE.Group(), soles: new THREE.Group(), forces: new THREE.Group(), plan: new THREE.Group()};
    this.scene.add(...Object.values(this.groups));
    this.frames = walk.frames.map(name => {
      const frame = new THREE.Group();
      (name.startsWith('sole_') ? this.groups.soles : this.groups.robot).add(frame);
      return frame;
    });
    this.ground = 0;
    this.still = [];  // materials of ground and things, with their colours
    for (const entity of walk.entities) this.place(entity);
    this.grid = gridOf(10, 0.5);
    this.grid.position.z = this.ground + 4e-3;
    this.scene.add(this.grid);
    this.cells = {}; this.arrows = {};
    for (const side of SIDES) if (walk.soles[side]) this.addSole(side);
    this.addBalance();
    this.shownPlan = -2;
    this.recolour();
    this.resize();
  }
  place(entity) {
    const frame = entity.frame === 'world' ? this.scene : this.frames[this.walk.frames.indexOf(entity.frame)];
    for (const shape of entity.shapes) {
      const mesh = meshOf(shape);
      if (!mesh || !frame) continue;
      if (entity.frame === 'world' && shape.kind === 'cube' && Math.min(shape.size[0], shape.size[1]) > 10)
        this.ground = shape.pose[2] + shape.size[2] / 2;
      if (entity.frame === 'world' && mesh.material) this.still.push([mesh.material, mesh.material.color.clone()]);
      frame.add(mesh);
    }
  }
  addSole(side) {
    const sole = this.walk.soles[side], at = [], owner = [];
    sole.cells.forEach((cell, taxel) => {
      for (let k = 1; k + 1 < cell.length; k++)
        for (const corner of [cell[0], cell[k], cell[k + 1]]) { at.push(corner[0], corner[1], 0); owner.push(taxel); }
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(at, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(at.length), 3));
    const frame = this.frames[this.walk.frames.indexOf('sole_' + side)];
    const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(over({vertexColors: true, opacity: 0.85,
      side: THREE.DoubleSide})));
    mesh.renderOrder = 2;
    frame.add(mesh);
    this.cells[side] = {geometry, owner};
    const arrow = new THREE.Group(), red = new THREE.MeshBasicMaterial(over({color: style('--cop')}));
    const shaft = new THREE.Mesh(new THREE.CylinderGeometry(0.006, 0.006, 1, 12).rotateX(Math.PI / 2).translate(0, 0, 0.5), red);
    const head = new THREE.Mesh(new THREE.ConeGeometry(0.016, 0.04, 16).rotateX(Math.PI / 2), red);
    shaft.renderOrder = head.renderOrder = 4;
    arrow.add(shaft, head);
    this.groups.forces.add(arrow);
    this.arrows[side] = {arrow, shaft, head, red};
  }
  addBalance() {
    const ball = (size, colour) => {
      const mesh = new THREE.Mesh(new THREE.SphereGeometry(size, 16, 12), new THREE.MeshBasicMaterial(over({color: colour})));
      mesh.renderOrder = 5;
      this.groups.forces.add(mesh);
      return mesh;
    };
    this.zmp = ball(0.012, style('--cop'));
    this.com = ball(0.018, '#f29a1a');
    const points = new THREE.BufferGeometry();
    points.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * CORNERS), 3));
    const fan = [];
    for (let k = 1; k + 1 < CORNERS; k++) fan.push(0, k, k + 1);
    points.setIndex(fan);
    this.polygon = new THREE.Group();
    const fill = new THREE.Mesh(points, new THREE.MeshBasicMaterial(over({color: '#1a9850', opacity: 0.3, side: THREE.DoubleSide})));
    const edge = new THREE.LineLoop(new THREE.BufferGeometry().setAttribute('position', points.getAttribute('position')),
      new THREE.LineBasicMaterial(over({color: '#1a9850'})));
    fill.frustumCulled = edge.frustumCulled = false;
    fill.renderOrder = 1; edge.renderOrder = 3;
    this.polygon.add(fill, edge);
    this.groups.forces.add(this.polygon);
    this.corners = points.getAttribute('position');
  }
  recolour() {
    this.scene.background = new THREE.Color(style('--sky'));
    this.grid.material.color = new THREE.Color(style('--grid'));
    const bright = Number(style('--ground'));
    for (const [material, colour] of this.still) material.color.copy(colour).multiplyScalar(bright);
  }
  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
  }
  draw(time, shown) {
    const walk = this.walk, i = walk.index(time);
    this.frames.forEach((frame, k) => walk.pose(k, time, frame.position, frame.quaternion));
    for (const [name, group] of Object.entries(this.groups)) group.visible = shown[name];
    const center = walk.frames.indexOf('center_of_mass');
    this.com.visible = center >= 0;
    if (center >= 0) this.com.position.copy(this.frames[center].position);
    for (const side of Object.keys(this.cells)) this.drawSole(side, i);
    const has = !Number.isNaN(walk.zmp[3 * i]);
    this.zmp.visible = has;
    if (has) this.zmp.position.fromArray(walk.zmp, 3 * i);
    const start = 3 * CORNERS * i;
    this.polygon.visible = !Number.isNaN(walk.polygon[start]);
    if (this.polygon.visible) {
      this.corners.array.set(walk.polygon.subarray(start, start + 3 * CORNERS));
      for (let k = 0; k < CORNERS; k++) this.corners.array[3 * k + 2] += 2e-3;
      this.corners.needsUpdate = true;
    }
    this.drawPlan(time);
    this.look(shown.follow);
    this.renderer.render(this.scene, this.camera);
  }
  drawSole(side, i) {
    const walk = this.walk, {geometry, owner} = this.cells[side], colours = geometry.getAttribute('color');
    const known = walk.soles[side].cells.map((_, k) => {
      const force = walk.force(side, k, i);
      return Number.isNaN(force) ? [0.5, 0.5, 0.5] : viridis(force / full);
    }).map(c => new THREE.Color().setRGB(c[0], c[1], c[2], THREE.SRGBColorSpace));
    owner.forEach((taxel, k) => colours.setXYZ(k, known[taxel].r, known[taxel].g, known[taxel].b));
    colours.needsUpdate = true;
    const cop = walk.cop(side, i), {arrow, shaft, head} = this.arrows[side];
    arrow.visible = cop !== null;
    if (!cop) return;
    const frame = this.frames[walk.frames.indexOf('sole_' + side)], length = ARROW * walk.totals[side][i] / walk.weight;
    arrow.position.set(cop[0], cop[1], 0).applyQuaternion(frame.quaternion).add(frame.position);
    arrow.quaternion.copy(frame.quaternion);
    shaft.scale.z = Math.max(length, 1e-4);
    head.position.z = length;
  }
  drawPlan(time) {
    let number = -1;
    this.walk.footsteps.forEach((plan, k) => { if (plan.time <= time + 1e-6) number = k; });
    if (number === this.shownPlan) return;
    this.shownPlan = number;
    for (const old of this.groups.plan.children) { old.geometry.dispose(); old.material.dispose(); }
    this.groups.plan.clear();
    if (number < 0) return;
    for (const entity of this.walk.footsteps[number].entities)
      for (const shape of entity.shapes) { const mesh = meshOf(shape); if (mesh) this.groups.plan.add(mesh); }
  }
  look(follow) {
    const center = this.walk.frames.indexOf('center_of_mass');
    const followed = center >= 0 ? this.frames[center].position : this.middle();
    if (follow || !this.seen) {
      this.target.copy(followed);
      this.seen = true;
    }
    const {azimuth, elevation, distance} = this.eye, away = Math.cos(elevation) * distance;
    this.camera.position.set(this.target.x + away * Math.cos(azimuth), this.target.y + away * Math.sin(azimuth),
      this.target.z + Math.sin(elevation) * distance);
    this.camera.lookAt(this.target);
  }
  middle() {
    const soles = this.walk.frames.map((name, k) => name.startsWith('sole_') ? this.frames[k].position : null).filter(Boolean);
    const sum = soles.reduce((a, b) => a.add(b), new THREE.Vector3());
    return sum.divideScalar(Math.max(soles.length, 1)).add(new THREE.Vector3(0, 0, 0.3));
  }
}

const walks = JSON.parse($('data').textContent).map(given => new Walk(given));
const end = Math.max(...walks.map(walk => walk.duration));
const full = Math.max(...walks.map(walk => walk.usual()));  // one scale for all, which are compared
const eye = {azimuth: SEEN.corner[0], elevation: SEEN.corner[1], distance: 3.4};
const sections = walks.map((_, k) => $('walk-' + k));
let time = 0, playing = false, last = 0, waiting = false;

const spaces = walks.map((walk, k) => {
  try {
    return new Space(walk, sections[k].querySelector('.space'), eye);
  } catch (error) {
    $('trouble').textContent = 'This browser cannot draw in 3D (' + error.message + '): soles and forces only.';
    sections[k].querySelector('.space').hidden = true;
    return null;
  }
});

function said(walk) {
  const i = walk.index(time);
  return SIDES.filter(s => walk.totals[s]).map(s => `${s} ${force(walk.totals[s][i])}`).join(', ');
}

function draw() {
  waiting = false;
  const shown = Object.fromEntries(['robot', 'soles', 'forces', 'plan', 'follow'].map(id => [id, $(id).checked]));
  walks.forEach((walk, k) => {
    const section = sections[k], i = walk.index(time);
    if (spaces[k]) spaces[k].draw(time, shown);
    drawSoles(walk, section.querySelector('.soles'), i, full);
    drawForces(walk, section.querySelector('.forces'), time, end);
    section.querySelector('.readout').textContent = said(walk) + (time > walk.duration ? ' (ended)' : '');
    const rows = SIDES.filter(s => walk.soles[s]).map(s => walk.perceived(s, i));
    const names = [...section.querySelectorAll('.perceived thead th')].map(cell => cell.textContent);
    section.querySelector('.perceived tbody').replaceChildren(...rows.map(words => tableRow(words, names)));
    let current = null;
    for (const item of section.querySelectorAll('.log li')) {
      item.classList.remove('now');
      if (Number(item.firstChild.dataset.time) <= time + 1e-3) current = item;
    }
    if (current) current.classList.add('now');
  });
  $('now').textContent = time.toFixed(2) + ' s';
  $('time').value = String(time);
  $('time').setAttribute('aria-valuetext', time.toFixed(2) + ' seconds');
  document.body.dataset.time = time.toFixed(3);
}

function tableRow(words, names) {
  const row = document.createElement('tr');
  words.forEach((word, k) => {
    const cell = document.createElement(k ? 'td' : 'th');
    cell.textContent = word;
    cell.dataset.of = names[k];
    row.append(cell);
  });
  row.firstChild.scope = 'row';
  row.firstChild.className = words[0];
  return row;
}

function soon() {
  if (!waiting && !playing) { waiting = true; requestAnimationFrame(draw); }
}

function go(to, tell) {
  time = Math.min(Math.max(to, 0), end);
  soon();
  if (tell) $('live').textContent = time.toFixed(2) + ' seconds: ' + walks.map(said).join('; ');
}

function step(pictures) {
  stop();
  const walk = walks.reduce((a, b) => a.duration >= b.duration ? a : b), i = walk.index(time) + pictures;
  go(walk.time[Math.min(Math.max(i, 0), walk.time.length - 1)], true);
}

function tick(now) {
  if (!playing) return;
  time += Math.min((now - last) / 1000, 0.25) * Number($('speed').value);
  last = now;
  if (time >= end) { time = end; stop(); }
  draw();
  if (playing) requestAnimationFrame(tick);
}

function stop() {
  playing = false;
  $('play').textContent = 'Play';
  $('play').setAttribute('aria-pressed', 'false');
}

function toggle() {
  if (playing) { stop(); go(time, true); return; }
  if (time >= end) time = 0;
  playing = true;
  $('play').textContent = 'Stop';
  $('play').setAttribute('aria-pressed', 'true');
  last = performance.now();
  requestAnimationFrame(tick);
}

function from(name) {
  $('from').value = name;
  [eye.azimuth, eye.elevation] = SEEN[name];
  soon();
}

function zoom(factor) {
  eye.distance = Math.min(Math.max(eye.distance * factor, 0.3), 30);
  soon();
}

const KEYS = {' ': toggle, ArrowLeft: e => e.shiftKey ? go(time - 1, true) : step(-1),
  ArrowRight: e => e.shiftKey ? go(time + 1, true) : step(1), Home: () => go(0, true), End: () => go(end, true),
  f: () => $('follow').click(), '+': () => zoom(0.8), '-': () => zoom(1.25)};
Object.keys(SEEN).forEach((name, k) => { KEYS[k + 1] = () => from(name); });

document.addEventListener('keydown', event => {
  // A control that has its own use of the key keeps it.
  if (event.ctrlKey || event.altKey || event.metaKey || !(event.key in KEYS)) return;
  if (event.target.closest('input, select, button, summary, .scroll')) return;
  event.preventDefault();
  KEYS[event.key](event);
});
$('play').addEventListener('click', toggle);
$('back').addEventListener('click', () => step(-1));
$('on').addEventListener('click', () => step(1));
$('time').addEventListener('input', () => { stop(); go(Number($('time').value)); });
$('from').addEventListener('change', () => from($('from').value));
for (const id of ['robot', 'soles', 'forces', 'plan', 'follow']) $(id).addEventListener('change', soon);
sections.forEach(section => {
  for (const button of section.querySelectorAll('[data-time]'))
    button.addEventListener('click', () => { stop(); go(Number(button.dataset.time), true); });
  const chart = section.querySelector('.forces');
  chart.addEventListener('pointerdown', e => { stop(); go(end * e.offsetX / chart.clientWidth); });
  turnable(section.querySelector('.space'));
});

// One finger or the mouse turns, two fingers or the wheel come nearer.
function turnable(canvas) {
  const held = new Map();
  const spread = () => { const [a, b] = [...held.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  canvas.addEventListener('pointerdown', e => { canvas.setPointerCapture(e.pointerId); held.set(e.pointerId, {x: e.clientX, y: e.clientY}); });
  canvas.addEventListener('pointermove', e => {
    const before = held.get(e.pointerId);
    if (!before) return;
    const apart = held.size === 2 ? spread() : 0;
    if (held.size === 1) {
      eye.azimuth -= 0.008 * (e.clientX - before.x);
      eye.elevation = Math.min(Math.max(eye.elevation + 0.008 * (e.clientY - before.y), -1.55), 1.55);
    }
    held.set(e.pointerId, {x: e.clientX, y: e.clientY});
    if (held.size === 2) zoom(apart / Math.max(spread(), 1));
    soon();
  });
  for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, e => held.delete(e.pointerId));
  canvas.addEventListener('wheel', e => { e.preventDefault(); zoom(Math.exp(0.001 * e.deltaY)); }, {passive: false});
}

$('time').max = String(end);
$('full').textContent = full + ' N';
new ResizeObserver(() => { for (const space of spaces) if (space) space.resize(); soon(); }).observe($('walks'));
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { for (const space of spaces) if (space) space.recolour(); soon(); });
const asked = /^#t=(\d+(?:\.\d+)?)$/.exec(location.hash);  // a link to an instant
if (asked) time = Math.min(Number(asked[1]), end);
draw();
document.body.dataset.ready = 'true';
})();
