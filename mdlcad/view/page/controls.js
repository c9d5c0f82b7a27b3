// The panel, the player and the mouse. `show` is what main.js offers: see there.

const element = (id) => document.getElementById(id);

function add(parent, tag, text, values = {}) {
  const made = document.createElement(tag);
  if (text) made.textContent = text;
  Object.assign(made, values);
  parent.append(made);
  return made;
}

function fillPanel(facts, show) {
  for (const [name, value] of facts.figures) {
    add(element('figures'), 'dt', name);
    add(element('figures'), 'dd', value);
  }
  for (const name of Object.keys(facts.legends)) add(element('colour'), 'option', name, { value: name });
  for (const name of Object.keys(facts.presets)) {
    add(element('presets'), 'button', name).addEventListener('click', () => show.from(name));
  }
  const boxes = facts.plates.map((plate, number) => {
    const label = add(add(element('plates'), 'li'), 'label');
    const box = add(label, 'input', '', { type: 'checkbox' });
    label.append(` ${plate}`);
    box.addEventListener('change', () => show.plate(number, box.checked));
    return box;
  });
  element('allPlates').addEventListener('click', () => show.plates(facts.plates));
  element('noPlates').addEventListener('click', () => show.plates([]));
  element('colour').addEventListener('change', (event) => show.colour(event.target.value));
  element('explode').addEventListener('input', (event) => show.explode(Number(event.target.value)));
  element('search').addEventListener('input', (event) => list(facts, event.target.value, show));
  element('search').addEventListener('keydown', (event) => {
    if (event.key === 'Enter') show.find(event.target.value);
    if (event.key === 'Escape') { event.target.value = ''; list(facts, '', show); show.find(''); }
    event.stopPropagation();
  });
  element('search').addEventListener('search', (event) => { if (!event.target.value) show.find(''); });
  element('fold').addEventListener('click', () => element('panel').classList.toggle('open'));
  element('play').addEventListener('click', () => show.play());
  element('time').addEventListener('input', (event) => show.frame(Number(event.target.value)));
  addEventListener('keydown', (event) => {
    if (event.target.tagName === 'SELECT' || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === '/') { event.preventDefault(); element('search').focus(); }
    if (event.key === ' ' && event.target.tagName !== 'BUTTON') { event.preventDefault(); show.play(); }
    if (event.key === 'Escape') show.find('');
    if (event.key === 'r') show.from('iso');
  });
  return boxes;
}

function list(facts, text, show) {
  const place = element('results');
  place.replaceChildren();
  for (const [words, name] of suggestions(facts, text)) {
    add(add(place, 'li'), 'button', words).addEventListener('click', () => { element('search').value = name; show.find(name); });
  }
}

function writeLegend(keys) {
  const place = element('legend');
  place.replaceChildren();
  for (const [colour, words] of keys) {
    const row = add(place, 'li');
    add(row, 'i').style.background = colour;
    row.append(words);
  }
}

function writeCard(facts, number) {
  const card = element('card');
  card.hidden = number < 0;
  if (number < 0) return;
  const body = facts.bodies[number];
  card.replaceChildren();
  add(card, 'h2', body.name);
  const table = add(card, 'dl');
  for (const [name, value] of facts.facts[body.facts]) {
    add(table, 'dt', name);
    add(table, 'dd', value);
  }
}

// One pointer turns, two pan and zoom; shift or the right button pans; the wheel zooms; no button points.
function listen(canvas, camera, show) {
  const down = new Map();
  const spread = () => {
    const [a, b] = [...down.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, far: Math.hypot(a.x - b.x, a.y - b.y) };
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY, pan: event.shiftKey || event.button !== 0 });
  });
  canvas.addEventListener('pointermove', (event) => {
    const before = down.get(event.pointerId);
    if (!before) { show.point(event.clientX, event.clientY); return; }
    const dx = event.clientX - before.x, dy = event.clientY - before.y;
    const old = down.size === 2 ? spread() : null;
    down.set(event.pointerId, { ...before, x: event.clientX, y: event.clientY });
    if (old) {
      const now = spread();
      camera.pan(now.x - old.x, now.y - old.y, canvas.clientHeight);
      camera.zoom(old.far / Math.max(now.far, 1));
    } else if (before.pan) camera.pan(dx, dy, canvas.clientHeight);
    else camera.drag(dx, dy);
    show.redraw();
  });
  for (const name of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(name, (event) => { down.delete(event.pointerId); show.point(event.clientX, event.clientY); });
  }
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(event.deltaY * 0.0012));
    show.redraw();
  }, { passive: false });
}
