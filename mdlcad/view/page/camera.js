// An orbiting camera with z up, and 4 x 4 matrices in WebGL's order (by columns).

function multiply(a, b) {
  const m = new Float32Array(16);
  for (let c = 0; c < 4; c++) {
    for (let r = 0; r < 4; r++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + r] * b[4 * c + k];
      m[4 * c + r] = sum;
    }
  }
  return m;
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const plus = (a, b, f) => [a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]];
const unit = (a) => { const l = Math.hypot(...a); return [a[0] / l, a[1] / l, a[2] / l]; };

class Camera {
  constructor(presets, viewAngle) {
    this.presets = presets;
    this.slope = Math.tan((viewAngle * Math.PI) / 360);
    this.focus = [0, 0, 0];
    this.distance = 100;
    this.turn = 0; // round z
    this.rise = 0; // above the x-y plane
    this.parallel = false;
  }

  preset(name) {
    const towards = unit(this.presets[name][0]);
    this.rise = Math.asin(Math.max(-1, Math.min(1, towards[2])));
    this.turn = Math.abs(towards[2]) > 0.999 ? -Math.PI / 2 : Math.atan2(towards[1], towards[0]);
    this.parallel = name !== 'iso';
  }

  // right, above, towards the camera
  axes() {
    const level = Math.cos(this.rise);
    const towards = [level * Math.cos(this.turn), level * Math.sin(this.turn), Math.sin(this.rise)];
    const right = [-Math.sin(this.turn), Math.cos(this.turn), 0];
    return [right, cross(towards, right), towards];
  }

  // See all corners of the box as large as can be, leaving free the shares of the picture that panels cover.
  // The same reckoning as in view/camera.py.
  fit(low, high, aspect, free) {
    const axes = this.axes();
    const middle = [0, 1, 2].map((i) => (low[i] + high[i]) / 2);
    const half = [0, 1, 2].map((i) => Math.max((high[i] - low[i]) / 2, 8));
    let centre = middle, far = 0;
    const edges = [this.slope * aspect * (1 - free.left - free.right), this.slope * (1 - free.top - free.bottom)];
    for (const k of [0, 1]) {
      const lean = this.parallel ? 0 : edges[k];
      let most = -Infinity, least = Infinity;
      for (let corner = 0; corner < 8; corner++) {
        const at = [0, 1, 2].map((i) => (corner >> i & 1 ? half[i] : -half[i]));
        const u = dot(at, axes[k]), w = dot(at, axes[2]);
        most = Math.max(most, u + lean * w);
        least = Math.min(least, u - lean * w);
      }
      centre = plus(centre, axes[k], (most + least) / 2);
      far = Math.max(far, (most - least) / (2 * edges[k]));
    }
    this.distance = far * 1.05;
    const height = this.distance * this.slope;
    centre = plus(centre, axes[0], (free.right - free.left) * height * aspect);
    this.focus = plus(centre, axes[1], (free.top - free.bottom) * height);
  }

  drag(dx, dy) {
    this.parallel = false;
    this.turn -= dx * 0.007;
    this.rise = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.rise + dy * 0.007));
  }

  pan(dx, dy, height) {
    const scale = (2 * this.distance * this.slope) / height;
    const [right, above] = this.axes();
    this.focus = plus(plus(this.focus, right, -dx * scale), above, dy * scale);
  }

  zoom(factor) {
    this.distance = Math.max(5, Math.min(20000, this.distance * factor));
  }

  matrix(aspect, reach) {
    const [right, above, towards] = this.axes();
    const place = plus(this.focus, towards, this.parallel ? 2 * reach : this.distance);
    const view = new Float32Array([
      right[0], above[0], towards[0], 0, right[1], above[1], towards[1], 0, right[2], above[2], towards[2], 0,
      -dot(right, place), -dot(above, place), -dot(towards, place), 1]);
    const far = (this.parallel ? 2 * reach : this.distance) + 2 * reach;
    const shape = new Float32Array(16);
    if (this.parallel) {
      const height = this.distance * this.slope;
      shape[0] = 1 / (height * aspect); shape[5] = 1 / height;
      shape[10] = -2 / far; shape[14] = -1; shape[15] = 1;
    } else {
      const near = Math.max(this.distance / 100, 1);
      shape[0] = 1 / (this.slope * aspect); shape[5] = 1 / this.slope;
      shape[10] = -(far + near) / (far - near); shape[11] = -1; shape[14] = (-2 * far * near) / (far - near);
    }
    return { view, whole: multiply(shape, view) };
  }
}
