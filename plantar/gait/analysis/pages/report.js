"use strict";
// The player: draws one frame of pressures, active cells, centre of pressure and support polygon for each foot.
(function () {
  const source = document.getElementById("player-data");
  const player = document.getElementById("player");
  if (!source || !player) return;
  const data = JSON.parse(source.textContent);
  const canvas = document.getElementById("player-canvas");
  const slider = document.getElementById("player-frame");
  const playButton = document.getElementById("player-play");
  const speed = document.getElementById("player-speed");
  const readout = document.getElementById("player-readout");
  const live = document.getElementById("player-live");
  const frames = data.times.length;
  const context = canvas.getContext("2d");
  let frame = 0, playing = false, startedAt = 0, startedFrom = 0, levels = null;

  // Viridis, as in the figures.
  const stops = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137],
    [53, 183, 121], [109, 205, 89], [180, 222, 44], [253, 231, 37]];
  function colour(share) {
    const x = Math.min(Math.max(share, 0), 1) * (stops.length - 1), i = Math.min(Math.floor(x), stops.length - 2);
    return "rgb(" + stops[i].map((c, k) => Math.round(c + (x - i) * (stops[i + 1][k] - c))).join(",") + ")";
  }

  async function unpack(text) {
    const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  function hull(points) {
    points.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const half = list => {
      const out = [];
      for (const p of list) {
        while (out.length > 1 && (out[out.length - 1][0] - out[out.length - 2][0]) * (p[1] - out[out.length - 2][1]) <=
          (out[out.length - 1][1] - out[out.length - 2][1]) * (p[0] - out[out.length - 2][0])) out.pop();
        out.push(p);
      }
      return out.slice(0, -1);
    };
    return points.length < 3 ? points : half(points).concat(half(points.slice().reverse()));
  }

  function bounds(foot) {
    const all = foot.outline.concat(...foot.cells), x = all.map(p => p[0]), y = all.map(p => p[1]);
    const low = (a) => a.reduce((p, q) => Math.min(p, q)), high = (a) => a.reduce((p, q) => Math.max(p, q));
    return { x0: low(x), x1: high(x), y0: low(y), y1: high(y) };
  }
  const boxes = data.feet.map(bounds);
  // Area of a usual cell in mm: how large cells are on the screen decides whether they are outlined.
  const outlined = data.feet.map(foot => {
    const areas = foot.cells.map(ring => Math.abs(ring.reduce((sum, p, i) => {
      const q = ring[(i + 1) % ring.length];
      return sum + (p[0] * q[1] - q[0] * p[1]) / 2;
    }, 0))).sort((a, b) => a - b);
    return areas[areas.length >> 1] || 0;
  });

  function trace(ring, at) {
    context.beginPath();
    ring.forEach((p, i) => { const [x, y] = at(p); if (i) context.lineTo(x, y); else context.moveTo(x, y); });
    context.closePath();
  }

  function css(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

  function draw() {
    const pad = 26, gap = 30, ink = css("--ink"), soft = css("--soft"), line = css("--line");
    const wide = boxes.reduce((sum, b) => sum + b.x1 - b.x0, 0);
    const tall = boxes.reduce((most, b) => Math.max(most, b.y1 - b.y0), 1);
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth;
    const widest = (width - 2 * pad - gap * (boxes.length - 1)) / wide;
    canvas.style.maxHeight = `${Math.ceil(widest * tall + 2 * pad)}px`;  // a narrow page has no empty band above the soles
    const height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const scale = Math.min(widest, (height - 2 * pad) / tall);
    let left = (width - scale * wide - gap * (boxes.length - 1)) / 2;
    data.feet.forEach((foot, f) => {
      const box = boxes[f], shift = left;
      const at = p => [shift + (p[0] - box.x0) * scale, height - pad - (p[1] - box.y0) * scale];
      trace(foot.outline, at);
      context.strokeStyle = soft; context.lineWidth = 1; context.stroke();
      const corners = [], count = foot.cells.length;
      for (let c = 0; c < count; c++) {
        const level = levels[f][frame * count + c];
        trace(foot.cells[c], at);
        if (level > 0) {
          context.fillStyle = colour((level - 1) / 254); context.fill();
          if (outlined[f] * scale * scale > 60) {  // cells of 8 pixels and more; an outline would hide smaller ones
            context.strokeStyle = ink; context.lineWidth = 0.8; context.stroke();
          }
          corners.push(...foot.cells[c]);
        } else {
          context.strokeStyle = line; context.lineWidth = 0.5; context.stroke();
        }
      }
      const polygon = hull(corners);
      if (polygon.length > 2) {
        trace(polygon, at);
        context.strokeStyle = css("--polygon"); context.lineWidth = 2; context.setLineDash([6, 4]);
        context.stroke(); context.setLineDash([]);
      }
      if (foot.cop[frame]) {
        const [x, y] = at(foot.cop[frame]);
        context.beginPath(); context.arc(x, y, 6, 0, 2 * Math.PI);
        context.fillStyle = css("--cop"); context.fill();
        context.strokeStyle = "#fff"; context.lineWidth = 2; context.stroke();
      }
      context.fillStyle = ink; context.font = "14px system-ui, sans-serif"; context.textAlign = "center";
      context.fillText(foot.side + (foot.force[frame] === null ? " (not measured)" : ""),
        shift + (box.x1 - box.x0) * scale / 2, 17);
      left += (box.x1 - box.x0) * scale + gap;
    });
  }

  function text() {
    const parts = data.feet.map((foot, f) => {
      if (foot.force[frame] === null) return foot.side + ": not measured";
      const count = foot.cells.length;
      let active = 0;
      for (let c = 0; c < count; c++) if (levels[f][frame * count + c] > 0) active++;
      return foot.side + ": " + Math.round(foot.force[frame]) + " " + data.forceUnit + ", " + active + " cells loaded";
    });
    return data.times[frame].toFixed(2) + " s; " + parts.join("; ");
  }

  function show(next, spoken) {
    frame = Math.min(Math.max(next, 0), frames - 1);
    slider.value = String(frame);
    draw();
    const words = text();
    readout.textContent = words;
    slider.setAttribute("aria-valuetext", words);
    if (spoken) live.textContent = words;
  }

  function stop() {
    playing = false;
    playButton.textContent = "Play";
    playButton.setAttribute("aria-pressed", "false");
    live.textContent = text();
  }

  function tick(now) {
    if (!playing) return;
    const time = data.times[startedFrom] + (now - startedAt) / 1000 * Number(speed.value);
    let next = frame;
    while (next < frames - 1 && data.times[next + 1] <= time) next++;
    if (next !== frame) show(next, false);
    if (frame >= frames - 1) stop(); else requestAnimationFrame(tick);
  }

  function start() {
    if (frame >= frames - 1) show(0, false);
    playing = true;
    startedAt = performance.now();
    startedFrom = frame;
    playButton.textContent = "Pause";
    playButton.setAttribute("aria-pressed", "true");
    requestAnimationFrame(tick);
  }

  function toEvent(direction) {
    const now = data.times[frame], list = data.events.map(e => e[0]);
    const later = direction > 0 ? list.find(t => t > now + 1e-6) : list.reverse().find(t => t < now - 1e-6);
    if (later === undefined) return;
    let best = 0;
    data.times.forEach((t, i) => { if (Math.abs(t - later) < Math.abs(data.times[best] - later)) best = i; });
    if (best === frame) best += direction;
    show(best, true);
  }

  Promise.all(data.feet.map(foot => unpack(foot.pressure))).then(unpacked => {
    levels = unpacked;
    slider.max = String(frames - 1);
    playButton.addEventListener("click", () => playing ? stop() : start());
    slider.addEventListener("input", () => { if (playing) stop(); show(Number(slider.value), false); });
    speed.addEventListener("change", () => { startedAt = performance.now(); startedFrom = frame; });
    const act = (id, step) => document.getElementById(id).addEventListener("click", () => { if (playing) stop(); step(); });
    act("player-back", () => show(frame - 1, true));
    act("player-forward", () => show(frame + 1, true));
    act("player-before", () => toEvent(-1));
    act("player-next", () => toEvent(1));
    player.addEventListener("keydown", event => {
      if (event.target === slider || event.target === speed || event.target.tagName === "BUTTON") return;
      if (event.key === "ArrowRight") show(frame + 1, true);
      else if (event.key === "ArrowLeft") show(frame - 1, true);
      else if (event.key === " ") { if (playing) stop(); else start(); } else return;
      event.preventDefault();
    });
    new ResizeObserver(() => draw()).observe(canvas);
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => draw());
    window.addEventListener("beforeprint", () => draw());
    player.querySelectorAll("button, input, select").forEach(control => { control.disabled = false; });
    const busiest = data.times.findIndex((t, i) => data.feet.some(foot => foot.force[i] > 0));
    show(Math.max(busiest, 0), false);
    player.dataset.ready = "true";
  }).catch(error => {
    readout.textContent = "The player needs a browser from 2023 or later (" + error + ").";
  });
})();
