// Maps: a canvas for each panel, all with one view of the image.

/** An image of categories, a pixel of it for each pixel of the run. */
function painted(width, height, classes, categoryOf) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height);
  const counts = new Array(classes.length).fill(0);
  const pixels = image.data;
  for (let at = 0; at < width * height; at++) {
    const category = categoryOf(at);
    counts[category]++;
    const colour = classes[category].colour;
    pixels[4 * at] = colour[0];
    pixels[4 * at + 1] = colour[1];
    pixels[4 * at + 2] = colour[2];
    pixels[4 * at + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  return { canvas, counts };
}

const css = (colour) => `rgb(${colour.join(" ")})`;

/** What part of the image all panels show: its middle, and CSS pixels for one of its pixels over those that fit. */
class View {
  constructor(width, height) {
    this.image = { width, height };
    this.fit();
  }

  fit() {
    this.zoom = 1;
    this.x = this.image.width / 2;
    this.y = this.image.height / 2;
  }

  get isFit() {
    return this.zoom === 1;
  }

  /** At most 48 CSS pixels a pixel of an image that fits into 600. */
  get mostZoom() {
    return Math.max(8, (this.image.width * 48) / 600);
  }

  keepInside() {
    const half = (side) => side / 2 / this.zoom;
    const clamp = (value, side) => Math.min(Math.max(value, half(side)), side - half(side));
    this.x = clamp(this.x, this.image.width);
    this.y = clamp(this.y, this.image.height);
  }

  /** Zooms by a factor about a place of the image, which stays where it is. */
  zoomBy(factor, x = this.x, y = this.y) {
    const before = this.zoom;
    this.zoom = Math.min(Math.max(before * factor, 1), this.mostZoom);
    const kept = before / this.zoom;
    this.x = x + (this.x - x) * kept;
    this.y = y + (this.y - y) * kept;
    this.keepInside();
  }

  moveBy(x, y) {
    this.x += x;
    this.y += y;
    this.keepInside();
  }

  /** Brings a pixel into the middle unless it is well inside. */
  show(x, y) {
    const far = (value, middle, side) => Math.abs(value - middle) > (0.4 * side) / this.zoom;
    if (far(x, this.x, this.image.width) || far(y, this.y, this.image.height)) {
      this.x = x;
      this.y = y;
      this.keepInside();
    }
  }
}

/** A canvas that shows a part of images. */
class Panel {
  constructor(figure, view, label) {
    this.figure = figure;
    this.view = view;
    this.canvas = document.createElement("canvas");
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-label", label);
    this.canvas.style.aspectRatio = `${view.image.width} / ${view.image.height}`;
    figure.querySelector("figcaption").after(this.canvas);
    figure.hidden = false;
  }

  /** CSS pixels for one of the image. */
  get scale() {
    return (this.canvas.clientWidth / this.view.image.width) * this.view.zoom;
  }

  /** The place of the image under a pointer. */
  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    const { view, scale } = this;
    return {
      x: view.x + (event.clientX - box.left - box.width / 2) / scale,
      y: view.y + (event.clientY - box.top - box.height / 2) / scale,
    };
  }

  begin() {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const wanted = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
    if (this.canvas.width !== wanted[0] || this.canvas.height !== wanted[1]) {
      [this.canvas.width, this.canvas.height] = wanted;
    }
    const context = this.canvas.getContext("2d");
    const scale = this.scale * ratio;
    const left = this.canvas.width / 2 - this.view.x * scale;
    const top = this.canvas.height / 2 - this.view.y * scale;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    return { context, ratio, scale, left, top };
  }

  /** Images from left to right, each up to a share of the width; pixels stay squares. */
  draw(parts, smooth) {
    const frame = this.begin();
    const { context, scale, left, top } = frame;
    let from = 0;
    for (const { image, until } of parts) {
      const to = Math.round(until * this.canvas.width);
      if (to > from) {
        context.save();
        context.beginPath();
        context.rect(from, 0, to - from, this.canvas.height);
        context.clip();
        context.imageSmoothingEnabled = smooth && scale < 1;
        context.drawImage(image, left, top, this.view.image.width * scale, this.view.image.height * scale);
        context.restore();
      }
      from = to;
      if (until < 1) {
        context.fillStyle = "#fff";
        context.fillRect(to - frame.ratio, 0, 2 * frame.ratio, this.canvas.height);
        context.fillStyle = "#000";
        context.fillRect(to - 2 * frame.ratio, 0, frame.ratio, this.canvas.height);
        context.fillRect(to + frame.ratio, 0, frame.ratio, this.canvas.height);
      }
    }
    return frame;
  }

  /** Pixels that must not be lost: as squares that are never too small to see, and in rings if they are rare. */
  mark(frame, marks, rare, rings, fill) {
    const { context, ratio, scale, left, top } = frame;
    const width = this.view.image.width;
    const visible = (x, y) => x >= -20 && y >= -20 && x <= this.canvas.width + 20 && y <= this.canvas.height + 20;
    const least = (marks.length <= 10 * rare ? 3 : 1.5) * ratio;
    const size = Math.max(scale, least);
    const byColour = new Map();
    for (const mark of marks) {
      const x = left + ((mark.at % width) + 0.5) * scale;
      const y = top + (Math.floor(mark.at / width) + 0.5) * scale;
      if (!visible(x, y)) continue;
      if (!byColour.has(mark.colour)) byColour.set(mark.colour, []);
      byColour.get(mark.colour).push([x, y]);
    }
    for (const [colour, places] of byColour) {
      if (fill && scale < least) {
        context.fillStyle = colour;
        for (const [x, y] of places) context.fillRect(x - size / 2, y - size / 2, size, size);
      }
      if (!rings || marks.length > rare) continue;
      const radius = Math.max(7 * ratio, 0.75 * scale + 3 * ratio);
      for (const [width, style] of [[5, "#000"], [2.5, colour]]) {
        context.strokeStyle = style;
        context.lineWidth = width * ratio;
        context.beginPath();
        for (const [x, y] of places) {
          context.moveTo(x + radius, y);
          context.arc(x, y, radius, 0, 2 * Math.PI);
        }
        context.stroke();
      }
    }
  }

  /** The pixel that is asked about, between two lines that show on any ground. */
  cursor(frame, pixel) {
    const { context, ratio, scale, left, top } = frame;
    const half = Math.max(scale / 2, 2 * ratio);
    const x = left + (pixel.x + 0.5) * scale;
    const y = top + (pixel.y + 0.5) * scale;
    for (const [out, style] of [[2, "#000"], [1, "#fff"]]) {
      const reach = half + out * ratio;
      context.strokeStyle = style;
      context.lineWidth = ratio;
      context.strokeRect(x - reach, y - reach, 2 * reach, 2 * reach);
      context.beginPath();
      const offset = (out - 1) * ratio;
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(x + dx * (reach + 2 * ratio) + dy * offset, y + dy * (reach + 2 * ratio) + dx * offset);
        context.lineTo(x + dx * (reach + 7 * ratio) + dy * offset, y + dy * (reach + 7 * ratio) + dx * offset);
      }
      context.stroke();
    }
  }
}
