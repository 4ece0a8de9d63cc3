// Draws the points without a GPU: each goes straight into the pixels, the nearest wins, and edges
// of depth are darkened afterwards. Lines that arrive are added to the picture that is there.

const POINT = 1;  // the flag of a point, see packed_points.hpp
const NEAREST_MM = 60;
const HIDDEN_MM = 30;   // so far behind another, a point is hidden with all its pixels
const MOST_PIXELS = 4;  // that a point covers, each way
// Pixels are alpha, blue, green, red, in signed words: unsigned ones do not fit the small integers
// with which JavaScript is quick.
const BACKGROUND = 0xff17110d | 0;

// What the colours mean: blue is to be trusted, vermillion is not, grey is on its way. Dark is
// low, light is high.
const RAMPS = {
  good: [[22, 66, 140], [0, 114, 178], [86, 180, 233], [232, 244, 252]],
  bad: [[126, 46, 8], [196, 82, 4], [236, 128, 58], [255, 232, 212]],
  running: [[78, 86, 98], [126, 134, 146], [184, 190, 198], [250, 250, 250]],
};

function rampColour(ramp, place) {
  const at = Math.min(place * (ramp.length - 1), ramp.length - 1.001);
  const [from, to] = [ramp[at | 0], ramp[(at | 0) + 1]];
  return from.map((value, k) => value + (to[k] - value) * (at - (at | 0)));
}

// 256 heights by 16 intensities, as pixels.
function makeColours(ramp) {
  const colours = new Int32Array(256 * 16);
  for (let height = 0; height < 256; ++height) {
    const rgb = rampColour(ramp, height / 255);
    for (let light = 0; light < 16; ++light) {
      const [r, g, b] = rgb.map((value) => Math.round(value * (0.72 + 0.28 * light / 15)));
      colours[height * 16 + light] = 0xff000000 | b << 16 | g << 8 | r;
    }
  }
  return colours;
}

class CloudCanvas {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.colours = {};
    for (const [name, ramp] of Object.entries(RAMPS)) this.colours[name] = makeColours(ramp);
    this.level = "running";
    this.ceiling_mm = Infinity;
    this.points = new Int16Array(0);  // x, y, z, then intensity and flag, of each
    this.count = 0;                   // points that may be drawn
    this.eye = { azimuth: -2.5, elevation: 0.85, distance_mm: 11000, target: [0, 0, 0] };
    this.shown = 0;  // points on the canvas
    this.resize();
  }

  resize() {
    const width = Math.max(this.canvas.clientWidth, 1);
    const height = Math.max(this.canvas.clientHeight, 1);
    if (this.canvas.width === width && this.canvas.height === height && this.image) return;
    this.canvas.width = width;
    this.canvas.height = height;
    this.image = this.context.createImageData(width, height);
    this.pixels = new Int32Array(this.image.data.buffer);
    this.flat = new Int32Array(width * height);   // colours before the edges are darkened
    this.depth = new Float32Array(width * height);
  }

  // Rows of the matrix that turns the rig's frame into the eye's: right, down, ahead.
  turn() {
    const { azimuth, elevation } = this.eye;
    const [ca, sa, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
    return [[-sa, ca, 0], [ca * se, sa * se, -ce], [-ca * ce, -sa * ce, -se]];
  }

  // The pixel of a place in mm; none behind the eye.
  project(x, y, z) {
    const [right, down, ahead] = this.turn();
    const [tx, ty, tz] = this.eye.target;
    const seen = (row) => row[0] * (x - tx) + row[1] * (y - ty) + row[2] * (z - tz);
    const depth = seen(ahead) + this.eye.distance_mm;
    if (depth < NEAREST_MM) return null;
    const focal = this.focal();
    return [this.canvas.width / 2 + focal * seen(right) / depth, this.canvas.height / 2 + focal * seen(down) / depth];
  }

  focal() { return 1.1 * Math.min(this.canvas.width, this.canvas.height); }

  draw() {
    this.resize();
    this.flat.fill(BACKGROUND);
    this.depth.fill(Infinity);
    this.shown = 0;
    this.splat(0, this.count);
    this.present();
  }

  // Adds points [first, end) to what is drawn.
  splat(first, end) {
    const { points, flat, depth } = this;
    const [right, down, ahead] = this.turn();
    const [tx, ty, tz] = this.eye.target;
    const [r0, r1, r2] = right, [d0, d1, d2] = down, [a0, a1, a2] = ahead;
    const width = this.canvas.width, height = this.canvas.height;
    const halfWidth = width / 2, halfHeight = height / 2;
    const focal = this.focal(), away = this.eye.distance_mm, ceiling = this.ceiling_mm;
    const colours = this.colours[this.level], low = this.low_mm, scale = 255 / Math.max(this.high_mm - low, 1);
    const spread = 16 * focal;  // points are some 16 mm apart: nearer ones cover more pixels
    let shown = 0;
    for (let at = 4 * first, stop = 4 * end; at < stop; at += 4) {
      const word = points[at + 3];
      const pz = points[at + 2];
      if ((word >> 8) !== POINT || pz > ceiling) continue;
      const x = points[at] - tx, y = points[at + 1] - ty, z = pz - tz;
      const far = a0 * x + a1 * y + a2 * z + away;
      if (far < NEAREST_MM) continue;
      const zoom = focal / far;
      const column = halfWidth + zoom * (r0 * x + r1 * y + r2 * z);
      const row = halfHeight + zoom * (d0 * x + d1 * y + d2 * z);
      if (column < 0 || row < 0 || column >= width - MOST_PIXELS || row >= height - MOST_PIXELS) continue;
      let level = (pz - low) * scale | 0;
      level = level < 0 ? 0 : level > 255 ? 255 : level;
      const light = (word & 255) >> 3;
      const colour = colours[level * 16 + (light > 15 ? 15 : light)];
      const pixel = (row | 0) * width + (column | 0);
      ++shown;
      if (depth[pixel] < far - HIDDEN_MM) continue;  // most points of a large cloud
      let side = spread / far + 1 | 0;
      if (side > MOST_PIXELS) side = MOST_PIXELS;
      for (let corner = pixel, last = pixel + side * width; corner < last; corner += width) {
        for (let place = corner; place < corner + side; ++place) {
          if (far < depth[place]) { depth[place] = far; flat[place] = colour; }
        }
      }
    }
    this.shown += shown;
  }

  // Darkens a pixel that lies behind its neighbours, so that shapes stand out.
  present() {
    const { pixels, flat, depth } = this;
    const width = this.canvas.width, end = width * (this.canvas.height - 1) - 1;
    pixels.set(flat);
    for (let pixel = width + 1; pixel < end; ++pixel) {
      const own = depth[pixel];
      if (own === Infinity) continue;
      const inverse = 1 / own;
      let behind = 0;
      let step = 1 - depth[pixel - 1] * inverse;
      if (step > 0) behind += step;
      step = 1 - depth[pixel + 1] * inverse;
      if (step > 0) behind += step;
      step = 1 - depth[pixel - width] * inverse;
      if (step > 0) behind += step;
      step = 1 - depth[pixel + width] * inverse;
      if (step > 0) behind += step;
      if (behind < 0.004) continue;
      const keep = 256 / (1 + 9 * behind) | 0;
      const colour = flat[pixel];
      pixels[pixel] = 0xff000000 | Math.imul(colour & 0xff00ff, keep) >>> 8 & 0xff00ff |
                      Math.imul(colour >>> 8 & 0xff, keep) & 0xff00;
    }
    this.context.putImageData(this.image, 0, 0);
  }

  // Where floor and ceiling are, of the points so far: for the colours, and for the first clip.
  heights() {
    const counts = new Uint32Array(700);  // of 100 mm each, from -35 m
    let all = 0;
    for (let at = 0, stop = 4 * this.count; at < stop; at += 4 * 7) {
      if ((this.points[at + 3] >> 8) !== POINT) continue;
      ++counts[(this.points[at + 2] + 35000) / 100 | 0];
      ++all;
    }
    const part = (share) => {
      let sum = 0;
      const bin = counts.findIndex((count) => (sum += count) > share * all);
      return 100 * bin - 35000;
    };
    return all === 0 ? null : { low_mm: part(0.02), high_mm: part(0.98) + 100 };
  }
}
