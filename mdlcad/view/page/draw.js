// The whole device in one draw call a pass: where a body stands, its colour and whether it is seen come from textures.

const POINT = `#version 300 es
precision highp float;
precision highp int;
layout(location = 0) in vec4 a_place;   // x, y, z, level
layout(location = 1) in vec4 a_follow;  // first, second, share, body
uniform mat4 u_whole, u_view;
uniform float u_gap;
uniform int u_pass;                     // 0 opaque, 1 translucent, 2 edges, 3 names
uniform sampler2D u_moved;              // a texel a reference: displacement in mm
uniform sampler2D u_colour;             // a texel a body: colour, and 0 hidden, 1/3 recedes, 2/3 usual, 1 found
out vec3 v_eye;
flat out vec4 v_colour;
flat out int v_body;
void main() {
  int body = int(a_follow.w);
  int row = textureSize(u_colour, 0).x;
  vec4 colour = texelFetch(u_colour, ivec2(body % row, body / row), 0);
  int wide = textureSize(u_moved, 0).x;
  ivec2 refs = ivec2(a_follow.xy);
  vec2 first = texelFetch(u_moved, ivec2(refs.x % wide, refs.x / wide), 0).xy;
  vec2 second = texelFetch(u_moved, ivec2(refs.y % wide, refs.y / wide), 0).xy;
  vec3 at = vec3(a_place.xy + mix(first, second, a_follow.z), a_place.z + u_gap * a_place.w);
  int state = int(colour.a * 3.0 + 0.5);
  bool here = u_pass == 0 ? state >= 2 : u_pass == 1 ? state == 1 : u_pass == 2 ? state >= 2 : state != 0;
  gl_Position = here ? u_whole * vec4(at, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  v_eye = (u_view * vec4(at, 1.0)).xyz;
  v_colour = vec4(colour.rgb, state == 1 ? 0.10 : 1.0);
  v_body = body;
}`;

const PIXEL = `#version 300 es
precision highp float;
precision highp int;
in vec3 v_eye;
flat in vec4 v_colour;
flat in int v_body;
uniform int u_pass;
out vec4 colour;
void main() {
  if (u_pass == 3) {
    int name = v_body + 1;
    colour = vec4(float(name & 255), float((name >> 8) & 255), float((name >> 16) & 255), 255.0) / 255.0;
    return;
  }
  if (u_pass == 2) { colour = vec4(v_colour.rgb * 0.42, 1.0); return; }
  vec3 normal = normalize(cross(dFdx(v_eye), dFdy(v_eye)));
  float light = 0.45 + 0.55 * abs(dot(normal, normalize(vec3(-0.35, 0.5, 1.0))));
  colour = vec4(v_colour.rgb * light, v_colour.a);
}`;

const HIDDEN = 0, RECEDES = 85, USUAL = 170, FOUND = 255;

class Drawing {
  constructor(canvas, mesh, references, bodies) {
    const gl = canvas.getContext('webgl2', { alpha: false, antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error('this browser has no WebGL 2, which draws the device');
    this.gl = gl;
    this.canvas = canvas;
    this.program = this.link();
    this.at = {};
    for (const name of ['u_whole', 'u_view', 'u_gap', 'u_pass', 'u_moved', 'u_colour']) {
      this.at[name] = gl.getUniformLocation(this.program, name);
    }
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, mesh.vertices, gl.STATIC_DRAW);
    for (const place of [0, 1]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 4, gl.FLOAT, false, 32, 16 * place);
    }
    this.triangles = this.indices(mesh.triangles);
    this.edges = this.indices(mesh.edges);
    this.moved = this.texture(references, gl.RG32F, gl.RG, gl.FLOAT, 2, Float32Array);
    this.colours = this.texture(bodies, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, 4, Uint8Array);
    this.names = null;
  }

  link() {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, POINT], [gl.FRAGMENT_SHADER, PIXEL]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  indices(data) {
    const gl = this.gl, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, data, gl.STATIC_DRAW);
    return { buffer, count: data.length };
  }

  // a texture of `count` texels in rows of at most 1024, with its values in this.data
  texture(count, inside, format, type, channels, Kind) {
    const gl = this.gl, width = Math.min(count, 1024), height = Math.ceil(count / width);
    const made = { id: gl.createTexture(), width, height, inside, format, type,
      data: new Kind(width * height * channels) };
    gl.bindTexture(gl.TEXTURE_2D, made.id);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    }
    this.send(made);
    return made;
  }

  send(made) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, made.id);
    gl.texImage2D(gl.TEXTURE_2D, 0, made.inside, made.width, made.height, 0, made.format, made.type, made.data);
  }

  prepare(matrices, gap) {
    const gl = this.gl;
    gl.useProgram(this.program);
    gl.bindVertexArray(this.array);
    gl.uniformMatrix4fv(this.at.u_whole, false, matrices.whole);
    gl.uniformMatrix4fv(this.at.u_view, false, matrices.view);
    gl.uniform1f(this.at.u_gap, gap);
    [this.moved, this.colours].forEach((made, place) => {
      gl.activeTexture(gl.TEXTURE0 + place);
      gl.bindTexture(gl.TEXTURE_2D, made.id);
    });
    gl.uniform1i(this.at.u_moved, 0);
    gl.uniform1i(this.at.u_colour, 1);
    gl.activeTexture(gl.TEXTURE2);
    gl.enable(gl.DEPTH_TEST);
  }

  pass(number, kind, set) {
    const gl = this.gl;
    gl.uniform1i(this.at.u_pass, number);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, set.buffer);
    gl.drawElements(kind, set.count, gl.UNSIGNED_INT, 0);
  }

  draw(matrices, gap, translucent) {
    const gl = this.gl;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0.953, 0.961, 0.973, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.prepare(matrices, gap);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    this.pass(0, gl.TRIANGLES, this.triangles);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    this.pass(2, gl.LINES, this.edges);
    if (!translucent) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    this.pass(1, gl.TRIANGLES, this.triangles);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  // Numbers of the bodies in a rectangle of pixels, as Int32Array, -1 for none; drawn at a fixed small size.
  bodiesAt(matrices, gap, x, y, width, height) {
    const gl = this.gl;
    if (!this.names || this.names.width !== this.canvas.width || this.names.height !== this.canvas.height) {
      this.names = this.target(this.canvas.width, this.canvas.height);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.names.frame);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(x, y, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.prepare(matrices, gap);
    this.pass(3, gl.TRIANGLES, this.triangles);
    const bytes = new Uint8Array(4 * width * height);
    gl.readPixels(x, y, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.disable(gl.SCISSOR_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const found = new Int32Array(width * height);
    for (let i = 0; i < found.length; i++) {
      found[i] = bytes[4 * i] + 256 * bytes[4 * i + 1] + 65536 * bytes[4 * i + 2] - 1;
    }
    return found;
  }

  target(width, height) {
    const gl = this.gl;
    if (this.names) {
      gl.deleteRenderbuffer(this.names.colour);
      gl.deleteRenderbuffer(this.names.depth);
      gl.deleteFramebuffer(this.names.frame);
    }
    const made = { frame: gl.createFramebuffer(), colour: gl.createRenderbuffer(), depth: gl.createRenderbuffer(),
      width, height };
    gl.bindFramebuffer(gl.FRAMEBUFFER, made.frame);
    for (const [buffer, format, place] of [[made.colour, gl.RGBA8, gl.COLOR_ATTACHMENT0],
      [made.depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
    }
    return made;
  }
}
