// What is shown, and how it changes. The address may say what to open at: #colour=phase&explode=0.5&find=tick.0

function hex(colour) {
  return [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));
}

function mixed(stops, share) {
  const at = Math.max(0, Math.min(1, share)) * (stops.length - 1);
  const low = Math.min(Math.floor(at), stops.length - 2);
  return stops[low].map((value, i) => Math.round(value + (at - low) * (stops[low + 1][i] - value)));
}

function start(facts, arrays) {
  const mesh = extrude(facts, arrays);
  const trace = traceOf(facts, arrays);
  const clocks = facts.moves.clocks.length, masses = facts.masses.length;
  const canvas = element('canvas');
  const drawing = new Drawing(canvas, mesh, 1 + clocks + masses, facts.bodies.length);
  const camera = new Camera(facts.presets, facts.viewAngle);
  const find = finder(facts);
  const logic = facts.state.logic.map(hex), wave = facts.state.wave.map(hex);
  const reach = 3 * Math.hypot(...mesh.bounds.reduce((most, b) => [Math.max(most[0], b[2]), Math.max(most[1], b[3])],
    [100, 100])) + 3 * facts.apart * facts.plates.length;
  const now = { shown: new Set(), explode: 0, colour: 'part', frame: -1, playing: false, found: [], pointed: -1,
    preset: 'iso' };
  let waiting = false, last = 0;

  const waves = (frame) => {
    const cycle = facts.run.framesPerCycle;
    return arrays.waves.subarray((frame % cycle) * clocks, (frame % cycle + 1) * clocks);
  };

  function stand() {
    const data = drawing.moved.data;
    data.fill(0);
    if (now.frame >= 0) {
      waves(now.frame).forEach((value, k) => { data[2 * (1 + k)] = facts.moves.clocks[k] * (value - 1); });
      for (let i = 0; i < masses; i++) {
        data[2 * (1 + clocks + i) + 1] = facts.moves.mass * trace.x[now.frame * masses + i];
      }
    }
    drawing.send(drawing.moved);
  }

  function paint() {
    const data = drawing.colours.data;
    const frame = Math.max(now.frame, 0);
    const found = new Set(now.found);
    const fixed = now.colour === 'state' ? arrays.phase : arrays[now.colour];
    facts.bodies.forEach((body, number) => {
      let colour = fixed.subarray(3 * number, 3 * number + 3);
      if (now.colour === 'state' && body.mass >= 0) {
        const x = trace.x[frame * masses + body.mass] * facts.polarity[body.mass];
        colour = mixed(logic, 0.5 + (0.5 * x) / facts.state.settled);
      } else if (now.colour === 'state' && body.clock >= 0) colour = mixed(wave, waves(frame)[body.clock] / 2);
      if (found.has(number)) colour = [229, 23, 123];
      const seen = !now.shown.has(body.plate) && !found.has(number) ? HIDDEN
        : found.has(number) ? FOUND : found.size ? RECEDES : USUAL;
      data.set([...colour, seen], 4 * number);
    });
    drawing.send(drawing.colours);
  }

  function matrices() {
    return camera.matrix(canvas.width / canvas.height, reach);
  }

  function draw() {
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    drawing.draw(matrices(), now.explode * facts.apart, now.found.length > 0);
  }

  function tell() {
    const cycle = Math.max(now.frame, 0) / facts.run.framesPerCycle;
    const decision = Math.min(Math.floor(cycle / facts.run.cycles), facts.run.words.length - 1);
    element('moment').value = now.frame < 0 ? `as drawn; play: ${facts.run.scenario}`
      : `cycle ${cycle.toFixed(1)}, decision ${decision}: ${facts.run.words[decision]}`;
    element('time').value = Math.max(now.frame, 0);
    element('play').textContent = now.playing ? '\u23F8' : '\u25B6';
  }

  function step(time) {
    waiting = false;
    if (now.playing && time - last > 48) {
      last = time;
      now.frame = (now.frame + 1) % trace.frames;
      stand();
      if (now.colour === 'state') paint();
      tell();
    }
    draw();
    if (now.playing) show.redraw();
  }

  function frameAll() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const gap = now.explode * facts.apart;
    const numbers = now.found.length ? now.found
      : facts.bodies.flatMap((body, i) => (now.shown.has(body.plate) ? [i] : []));
    for (const number of numbers) {
      const body = facts.bodies[number], box = mesh.bounds[number];
      const least = [box[0], box[1], body.z[0] + gap * body.level[0]];
      const most = [box[2], box[3], body.z[1] + gap * body.level[1]];
      for (const i of [0, 1, 2]) { low[i] = Math.min(low[i], least[i]); high[i] = Math.max(high[i], most[i]); }
    }
    if (!numbers.length) return;
    const width = canvas.clientWidth, wide = width > 720;
    const free = wide ? { left: 276 / width, right: now.found.length ? Math.min(0.4, 360 / width) : 0, top: 0,
      bottom: 64 / canvas.clientHeight } : { left: 0, right: 0, top: now.found.length ? 0.44 : 0.08, bottom: 0.14 };
    camera.fit(low, high, width / canvas.clientHeight, free);
  }

  const show = {
    redraw() { if (!waiting) { waiting = true; requestAnimationFrame(step); } },
    from(name) { now.preset = name; camera.preset(name); frameAll(); show.redraw(); },
    plate(number, on) { if (on) now.shown.add(number); else now.shown.delete(number); paint(); show.redraw(); },
    plates(names) {
      now.shown = new Set(names.map((name) => facts.plates.indexOf(name)));
      boxes.forEach((box, number) => { box.checked = now.shown.has(number); });
      paint();
      show.redraw();
    },
    colour(name) {
      now.colour = name;
      element('colour').value = name;
      if (name === 'state' && now.frame < 0) {
        show.frame(Math.min(facts.run.cycles * facts.run.framesPerCycle - 1, trace.frames - 1));
      }
      writeLegend(facts.legends[name]);
      paint();
      show.redraw();
    },
    explode(share) {
      now.explode = share;
      element('explode').value = share;
      element('explodeValue').value = share ? `${Math.round(100 * share)} %` : '';
      frameAll();
      show.redraw();
    },
    frame(number) {
      now.frame = Math.max(-1, Math.min(number, trace.frames - 1));
      stand();
      if (now.colour === 'state') paint();
      tell();
      show.redraw();
    },
    play() {
      now.playing = !now.playing;
      if (now.playing && now.colour === 'part') show.colour('state');
      tell();
      show.redraw();
    },
    find(text) {
      now.found = find(text);
      element('search').setCustomValidity(text && !now.found.length ? 'nothing of this name' : '');
      element('search').reportValidity();
      writeCard(facts, now.found.length ? foremost(facts, now.found) : -1);
      paint();
      frameAll();
      show.redraw();
      return now.found.length;
    },
    point(x, y) {
      const box = canvas.getBoundingClientRect(), scale = canvas.width / box.width;
      const at = [Math.floor((x - box.left) * scale), canvas.height - 1 - Math.floor((y - box.top) * scale)];
      const body = drawing.bodiesAt(matrices(), now.explode * facts.apart, ...at, 1, 1)[0];
      if (body === now.pointed) return;
      now.pointed = body;
      if (!now.found.length) writeCard(facts, body);
      else writeCard(facts, now.found.includes(body) ? body : foremost(facts, now.found));
    },
  };

  const boxes = fillPanel(facts, show);
  element('time').max = trace.frames - 1;
  listen(canvas, camera, show);
  addEventListener('resize', () => show.redraw());

  const asked = new URLSearchParams(location.hash.slice(1));
  const look = (name) => (asked.has(name) ? asked.get(name) : facts.look[name]);
  show.plates(asked.has('plates') ? asked.get('plates').split(',') : facts.look.plates);
  show.explode(Number(look('explode')));
  const at = look('at');
  if (at !== null) show.frame(Math.round(Number(at) * facts.run.framesPerCycle)); else tell();
  show.colour(facts.legends[look('colour')] ? look('colour') : 'part');
  draw();
  show.from(facts.presets[look('camera')] ? look('camera') : 'iso');
  if (look('find')) { element('search').value = look('find'); show.find(look('find')); }
  draw();
  // how much of the device is seen, for whoever tests the page
  const seen = drawing.bodiesAt(matrices(), now.explode * facts.apart, 0, 0, canvas.width, canvas.height);
  document.documentElement.dataset.bodiesSeen = new Set(seen.filter((number) => number >= 0)).size;
  document.documentElement.dataset.triangles = mesh.triangles.length / 3;
  draw();
  return show;
}

function complain(problem) {
  element('trouble').hidden = false;
  element('trouble').textContent = `The device cannot be drawn: ${problem.message}`;
}

unpack().then(({ facts, arrays }) => start(facts, arrays)).catch(complain);
