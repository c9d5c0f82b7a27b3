// What view/page/pack.py wrote: facts (JSON) and typed arrays, unpacked; and the outlines extruded to prisms.

const TYPES = { i4: Int32Array, u4: Uint32Array, u2: Uint16Array, u1: Uint8Array, f4: Float32Array };

async function unpack() {
  const facts = JSON.parse(document.getElementById('facts').textContent);
  const text = atob(document.getElementById('block').textContent.trim());
  const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  const buffer = await new Response(stream).arrayBuffer();
  const arrays = {};
  let start = 0;
  for (const [name, [type, count]] of Object.entries(facts.arrays)) {
    const size = TYPES[type].BYTES_PER_ELEMENT * count;
    arrays[name] = new TYPES[type](buffer.slice(start, start + size));
    start += size;
  }
  return { facts, arrays };
}

// displacements of every mass at every frame, in units of x
function traceOf(facts, arrays) {
  const masses = facts.masses.length;
  const frames = arrays.trace.length / masses;
  const x = new Float32Array(arrays.trace.length);
  const steps = new Uint8Array(masses);
  for (let frame = 0; frame < frames; frame++) {
    for (let mass = 0; mass < masses; mass++) {
      const place = frame * masses + mass;
      steps[mass] += arrays.trace[place];
      x[place] = ((steps[mass] << 24) >> 24) * facts.run.step;
    }
  }
  return { frames, x };
}

// Prisms of all bodies in one mesh: vertices of 9 numbers (x, y, z, level, first, second, share, body, 0),
// triangles, and the edges of both faces.
function extrude(facts, arrays) {
  const count = arrays.points.length / 2;
  const vertices = new Float32Array(2 * count * 8);
  const capTotal = arrays.caps.length / 3;
  const triangles = new Uint32Array(3 * (2 * capTotal + 2 * count));
  const edges = new Uint32Array(4 * count);
  const bounds = [];
  let x = 0, y = 0, point = 0, ring = 0, cap = 0, out = 0, line = 0;
  facts.bodies.forEach((body, number) => {
    const rings = arrays.rings[number];
    const n = arrays.ends[ring + rings - 1];
    const low = 2 * point, high = low + n;
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = 0; i < n; i++) {
      const from = point + i;
      x += arrays.points[2 * from];
      y += arrays.points[2 * from + 1];
      const px = x * facts.grid, py = y * facts.grid;
      box[0] = Math.min(box[0], px); box[1] = Math.min(box[1], py);
      box[2] = Math.max(box[2], px); box[3] = Math.max(box[3], py);
      for (const side of [0, 1]) {
        const at = 8 * (side ? high + i : low + i);
        vertices.set([px, py, body.z[side], body.level[side], arrays.first[from], arrays.second[from],
          arrays.share[from] / 255, number], at);
      }
    }
    for (let i = 0; i < arrays.capCounts[number]; i++, cap++) {
      const [a, b, c] = arrays.caps.subarray(3 * cap, 3 * cap + 3);
      triangles.set([low + c, low + b, low + a, high + a, high + b, high + c], out);
      out += 6;
    }
    let begin = 0;
    for (let r = 0; r < rings; r++) {
      const end = arrays.ends[ring + r];
      for (let i = begin; i < end; i++) {
        const j = i + 1 < end ? i + 1 : begin;
        triangles.set([low + i, low + j, high + j, low + i, high + j, high + i], out);
        edges.set([low + i, low + j, high + i, high + j], line);
        out += 6;
        line += 4;
      }
      begin = end;
    }
    bounds.push(box);
    ring += rings;
    point += n;
  });
  return { vertices, triangles, edges, bounds };
}
