// Plays recorded episodes, two policies side by side on one clock.
(async () => {
  const packed = Uint8Array.from(atob(document.getElementById("replays").textContent), (sign) => sign.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const episodes = JSON.parse(await new Response(stream).text());
  const COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#555555"];
  const KINDS = [[201, 205, 210], [255, 255, 255], [34, 34, 34]];
  const LAYERS = { map: "map as believed", walls: "true walls", "true": "true path", believed: "believed path",
    particles: "particles", scans: "scan", planned: "planned path", goals: "goal" };
  const $ = (id) => document.getElementById(id);
  const shown = {};
  for (const [name, title] of Object.entries(LAYERS)) {
    if (!episodes.some((one) => one[name])) continue;
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox"; box.checked = true; box.id = `layer-${name}`; shown[name] = true;
    box.addEventListener("change", () => { shown[name] = box.checked; drawAll(); });
    label.append(box, ` ${title}`); $("layers").append(label);
  }

  class View {
    constructor(canvas, choice) {
      this.canvas = canvas; this.context = canvas.getContext("2d"); this.choice = choice;
      choice.addEventListener("change", () => { this.load(); drawAll(); });
    }
    load() {
      this.episode = episodes.find((one) => one.env === $("env").value && one.policy === this.choice.value);
      this.frame = -1;
      if (!this.episode) return;
      const { map } = this.episode;
      if (map) {
        this.layer = new OffscreenCanvas(map.columns, map.rows);
        this.pixels = new ImageData(map.columns, map.rows);
        this.clear();
      }
      this.fit();
    }
    clear() {
      for (let i = 0; i < this.pixels.data.length; i += 4) this.pixels.data.set([...KINDS[0], 255], i);
      this.mapped = -1;
    }
    fit() { // the whole world fills the canvas
      const one = this.episode, xs = [], ys = [];
      for (const [x1, y1, x2, y2] of one.walls || []) { xs.push(x1, x2); ys.push(y1, y2); }
      for (const [x, y, r] of one.pillars || []) { xs.push(x - r, x + r); ys.push(y - r, y + r); }
      for (const poses of one["true"] || one.believed) for (const [x, y] of poses) { xs.push(x); ys.push(y); }
      for (const goals of one.goals || []) for (const [x, y] of goals) { xs.push(x); ys.push(y); }
      const least = (list) => list.reduce((a, b) => Math.min(a, b), Infinity);
      const most = (list) => list.reduce((a, b) => Math.max(a, b), -Infinity);
      const [left, right, low, high] = [least(xs), most(xs), least(ys), most(ys)];
      const margin = 0.03 * Math.max(right - left, high - low, 500);
      const { width, height } = this.canvas;
      this.scale = Math.min(width / (right - left + 2 * margin), height / (high - low + 2 * margin));
      this.left = (left + right) / 2 - width / 2 / this.scale;
      this.top = (low + high) / 2 + height / 2 / this.scale;
    }
    x(mm) { return (mm - this.left) * this.scale; }
    y(mm) { return (this.top - mm) * this.scale; }
    mapUntil(frame) { // apply the changes of cells; backwards means from the beginning
      const { map } = this.episode;
      if (frame < this.mapped) this.clear();
      for (let k = this.mapped + 1; k <= frame; k++) {
        let code = 0;
        for (const step of map.changes[k]) {
          code += step;
          const cell = Math.floor(code / 3), column = cell % map.columns, row = (cell - column) / map.columns;
          this.pixels.data.set(KINDS[code % 3], 4 * ((map.rows - 1 - row) * map.columns + column));
        }
      }
      if (frame !== this.mapped) this.layer.getContext("2d").putImageData(this.pixels, 0, 0);
      this.mapped = frame;
    }
    draw(time) {
      const { context, canvas, episode: one } = this;
      context.fillStyle = "#c9cdd2"; context.fillRect(0, 0, canvas.width, canvas.height);
      if (!one) return;
      let low = 0, high = one.times.length - 1;
      while (low < high) { const mid = (low + high + 1) >> 1; if (one.times[mid] <= time) low = mid; else high = mid - 1; }
      this.frame = low;
      const next = Math.min(low + 1, one.times.length - 1), gap = one.times[next] - one.times[low];
      const share = gap > 0 ? Math.min(1, Math.max(0, (time - one.times[low]) / gap)) : 0;
      if (!one.map) { context.fillStyle = "#fff"; context.fillRect(0, 0, canvas.width, canvas.height); }
      if (one.map && shown.map) {
        this.mapUntil(low);
        const { map } = one, side = 1000 * map.resolution * this.scale;
        context.imageSmoothingEnabled = false;
        context.drawImage(this.layer, this.x(1000 * map.origin[0]),
          this.y(1000 * (map.origin[1] + map.rows * map.resolution)), side * map.columns, side * map.rows);
      }
      if (one.walls && shown.walls) this.walls(one);
      const poses = this.at(one["true"], low, next, share), guess = this.at(one.believed, low, next, share);
      for (const [kind, now, dash] of [["true", poses, []], ["believed", guess, [5, 4]]]) {
        if (one[kind] && shown[kind]) now.forEach((pose, robot) => this.path(one[kind], low, pose, robot, kind, dash));
      }
      if (one.planned && shown.planned) this.line(one.planned[low].map(([x, y]) => [10 * x, 10 * y]), "#009E73", 2, [2, 4]);
      if (one.scans && shown.scans && one.angles.length) (one["true"] || one.believed)[low].forEach((pose, robot) => this.scan(one, low, pose, robot));
      if (one.goals && shown.goals) one.goals[low].forEach(([x, y], robot) => this.star(x, y, robot, one.goals[low].length));
      if (one.particles && shown.particles) {
        context.fillStyle = "#c2185b";
        for (const [x, y] of one.particles[low]) context.fillRect(this.x(10 * x) - 1.5, this.y(10 * y) - 1.5, 3, 3);
      }
      if (guess && shown.believed) guess.forEach((pose, robot) => this.robot(pose, robot, true));
      if (poses) poses.forEach((pose, robot) => this.robot(pose, robot, false));
    }
    at(series, low, next, share) {
      if (!series) return null;
      return series[low].map(([x, y, turn], robot) => {
        const [u, v, then] = series[next][robot];
        let change = then - turn;
        change -= 6283 * Math.round(change / 6283);
        return [x + share * (u - x), y + share * (v - y), turn + share * change];
      });
    }
    line(points, colour, width, dash = []) {
      const { context } = this;
      context.strokeStyle = colour; context.lineWidth = width; context.setLineDash(dash); context.beginPath();
      points.forEach(([x, y], place) => (place ? context.lineTo(this.x(x), this.y(y)) : context.moveTo(this.x(x), this.y(y))));
      context.stroke(); context.setLineDash([]);
    }
    walls(one) {
      const { context } = this;
      context.strokeStyle = "#7A5195"; context.lineWidth = 1.2; context.beginPath();
      for (const [x1, y1, x2, y2] of one.walls) { context.moveTo(this.x(x1), this.y(y1)); context.lineTo(this.x(x2), this.y(y2)); }
      for (const [x, y, r] of one.pillars || []) {
        context.moveTo(this.x(x + r), this.y(y)); context.arc(this.x(x), this.y(y), r * this.scale, 0, 7);
      }
      context.stroke();
    }
    path(series, frame, pose, robot, kind, dash) {
      const points = series.slice(0, frame + 1).map((poses) => poses[robot]);
      this.line([...points, pose], this.colour(robot, kind === "believed", series[0].length), 1.6, dash);
    }
    colour(robot, believed, robots) { return COLOURS[(robots > 1 ? robot : believed ? 1 : 0) % COLOURS.length]; }
    scan(one, frame, [x, y, turn], robot) {
      const ranges = one.scans[frame][robot];
      if (!ranges) return;
      this.context.fillStyle = "rgba(204, 0, 0, 0.75)";
      const farthest = Math.max(...ranges);
      ranges.forEach((range, beam) => {
        if (range <= 0 || range >= farthest - 1 && farthest > 300) return; // met nothing
        const angle = turn / 1000 + one.angles[beam];
        this.context.fillRect(this.x(x + 10 * range * Math.cos(angle)) - 1, this.y(y + 10 * range * Math.sin(angle)) - 1, 2.5, 2.5);
      });
    }
    star(x, y, robot, robots) {
      const { context } = this;
      context.fillStyle = robots > 1 ? COLOURS[robot % COLOURS.length] : "#E69F00"; context.strokeStyle = "#222";
      context.lineWidth = 1; context.beginPath();
      for (let k = 0; k < 10; k++) {
        const radius = k % 2 ? 4 : 9, angle = -Math.PI / 2 + (k * Math.PI) / 5;
        context.lineTo(this.x(x) + radius * Math.cos(angle), this.y(y) + radius * Math.sin(angle));
      }
      context.closePath(); context.fill(); context.stroke();
    }
    robot([x, y, turn], robot, believed) {
      const { context } = this, radius = Math.max(4, (this.episode.radius || 100) * this.scale);
      const robots = (this.episode["true"] || this.episode.believed)[0].length;
      context.strokeStyle = this.colour(robot, believed, robots); context.fillStyle = believed ? "transparent" : context.strokeStyle + "";
      context.lineWidth = 2; context.beginPath(); context.arc(this.x(x), this.y(y), radius, 0, 7);
      if (!believed) { context.globalAlpha = 0.35; context.fill(); context.globalAlpha = 1; }
      context.moveTo(this.x(x), this.y(y));
      context.lineTo(this.x(x) + 1.7 * radius * Math.cos(turn / 1000), this.y(y) - 1.7 * radius * Math.sin(turn / 1000));
      context.stroke();
    }
  }

  const choices = [...document.querySelectorAll("select.policy")];
  const views = [...document.querySelectorAll("#player canvas")].map((canvas, place) => new View(canvas, choices[place]));
  const options = (select, names) => select.replaceChildren(...names.map((name) => new Option(name)));
  const player = { time: 0, playing: false, drawn: 0, end: 0, episodes: episodes.length };
  window.lidarenaPlayer = player;

  function drawAll() {
    views.forEach((view) => view.draw(player.time));
    player.drawn += 1;
    player.frame = views[0].frame;
    $("time").value = player.end ? (1000 * player.time) / player.end : 0;
    $("clock").textContent = `${player.time.toFixed(1)} s`;
  }
  function chooseEnv() {
    const names = episodes.filter((one) => one.env === $("env").value).map((one) => one.policy);
    choices.forEach((choice, place) => { options(choice, names); choice.selectedIndex = Math.min(place, names.length - 1); });
    views[1].canvas.closest("figure").hidden = names.length < 2;
    views.forEach((view) => view.load());
    player.end = Math.max(...episodes.filter((one) => one.env === $("env").value).map((one) => one.times.at(-1)));
    player.time = 0;
    drawAll();
  }
  function play(on) {
    player.playing = on;
    $("play").textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (player.time >= player.end) player.time = 0;
    let last = null;
    const step = (now) => {
      if (!player.playing) return;
      if (last !== null) player.time = Math.min(player.end, player.time + (+$("speed").value * (now - last)) / 1000);
      last = now;
      drawAll();
      if (player.time >= player.end) play(false); else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }
  options($("env"), [...new Set(episodes.map((one) => one.env))]);
  $("env").addEventListener("change", chooseEnv);
  $("play").addEventListener("click", () => play(!player.playing));
  $("time").addEventListener("input", () => { player.time = ($("time").value / 1000) * player.end; drawAll(); });
  chooseEnv();
  player.ready = true;
})();
