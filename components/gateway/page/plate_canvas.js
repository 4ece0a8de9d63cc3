// The plate from above: what was measured at its height, its outline where the calibration says
// that it stands, and the ring in which it is looked for.

const PLATE_REACH_MM = 150;

class PlateCanvas {
  constructor(canvas) {
    this.canvas = canvas;
    this.places = [];  // x, y of the points at the plate's height
  }

  clear() { this.places = []; }

  // Looks at points [first, end).
  add(points, first, end, plate) {
    const half = plate.ring_thickness_mm / 2;
    const reach = PLATE_REACH_MM * PLATE_REACH_MM;
    for (let at = 4 * first; at < 4 * end; at += 4) {
      if ((points[at + 3] >> 8) !== POINT || Math.abs(points[at + 2] - plate.height_mm) > half) continue;
      const x = points[at], y = points[at + 1];
      if (x * x + y * y < reach) this.places.push(x, y);
    }
  }

  // alpha_deg: where the plate stands in this picture's frame; null where nobody knows.
  draw(plate, alpha_deg, colour) {
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = this.canvas.clientWidth * ratio;
    this.canvas.height = this.canvas.clientHeight * ratio;
    const pen = this.canvas.getContext("2d");
    const scale = this.canvas.height / 236;
    // X to the right, Y up; the ring is on the side of X.
    pen.setTransform(scale, 0, 0, -scale, this.canvas.width / 2 - 62 * scale, this.canvas.height / 2);
    this.drawRing(pen, plate);
    pen.fillStyle = colour;
    pen.globalAlpha = Math.max(0.12, Math.min(0.8, 500 / (1 + this.places.length)));
    for (let k = 0; k < this.places.length; k += 2) pen.fillRect(this.places[k] - 0.8, this.places[k + 1] - 0.8, 1.6, 1.6);
    pen.globalAlpha = 1;
    if (alpha_deg !== null) this.drawOutline(pen, plate, alpha_deg * Math.PI / 180);
  }

  drawRing(pen, plate) {
    pen.strokeStyle = "#4a5666";
    pen.lineWidth = 0.7;
    for (const radius of [plate.ring_inner_mm, plate.ring_outer_mm]) {
      pen.beginPath();
      pen.arc(0, 0, radius, -Math.PI / 2, Math.PI / 2);
      pen.stroke();
    }
    pen.beginPath();
    pen.moveTo(-6, 0); pen.lineTo(6, 0); pen.moveTo(0, -6); pen.lineTo(0, 6);
    pen.stroke();
  }

  drawOutline(pen, plate, alpha_rad) {
    const half = plate.hypotenuse_mm / 2;
    const near = plate.base_distance_mm;
    pen.save();
    pen.rotate(alpha_rad);
    pen.strokeStyle = "#f0e442";
    pen.lineWidth = 1.2;
    pen.beginPath();
    pen.moveTo(near, -half); pen.lineTo(near + half, 0); pen.lineTo(near, half);
    pen.closePath();
    pen.stroke();
    pen.restore();
  }
}
