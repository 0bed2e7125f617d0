// A scene's maps, the slider, and the pixel that is asked about.

const CAUSES = ["", "epsilon", "input rounding", "traversal"];

class Viewer {
  constructor(root) {
    this.root = root;
    this.data = JSON.parse(root.querySelector("script.data").textContent);
    this.find = (selector) => root.querySelector(selector);
    this.pixel = { x: this.data.width >> 1, y: this.data.height >> 1 };
    this.picked = false;
    this.answersOf = new Map();
  }

  static async of(root) {
    const viewer = new Viewer(root);
    const { data } = viewer;
    const image = viewer.find("img.picture");
    await image.decode();
    viewer.image = image;
    const objects = await unpack(data.objects);
    const pixels = data.width * data.height;
    viewer.objectAt = (at) => objects[at] | (objects[pixels + at] << 8) | (objects[2 * pixels + at] << 16);
    viewer.build();
    await viewer.chooseLight(0);
    viewer.beginAtFirstWrong();
    root.classList.add("ready");
    return viewer;
  }

  build() {
    const { data } = this;
    this.view = new View(data.width, data.height);
    const labels = {
      picture: "Picture. Arrow keys move the pixel that is asked about",
      shadows: "Shadows. Arrow keys move the pixel that is asked about",
      difference: "Difference map. Arrow keys move the pixel that is asked about",
      verdict: "Verdict map. Arrow keys move the pixel that is asked about",
    };
    this.panels = {};
    for (const figure of this.root.querySelectorAll(".panel")) {
      const name = figure.dataset.panel;
      this.panels[name] = new Panel(figure, this.view, labels[name]);
    }
    this.image.hidden = true;
    for (const hidden of this.root.querySelectorAll(".tools, .help, .readout")) hidden.hidden = false;
    this.slider = this.find("input[type=range]");
    this.fillTesters();
    this.listen();
    for (const panel of Object.values(this.panels)) this.follow(panel);
    new ResizeObserver(() => this.redraw()).observe(this.root);
    window.addEventListener("beforeprint", () => this.draw());
  }

  fillTesters() {
    const { data } = this;
    const [tester, other] = [this.find(".tester"), this.find(".other")];
    const option = (name, text = name) => new Option(text, data.testers.indexOf(name));
    const rivals = data.testers.filter((name) => name !== data.truth);
    tester.append(...rivals.map((name) => option(name)));
    other.append(...rivals.map((name) => option(name)), option(data.truth, "the truth"));
    const first = rivals.includes(data.shadow) ? data.shadow : rivals[0] ?? data.truth;
    if (!rivals.length) tester.append(option(data.truth, "the truth"));
    // Embree as it is judged, else in any mode that was asked.
    const embree = ["embree", ...rivals].find((name) => name.startsWith("embree") && rivals.includes(name) && name !== first);
    tester.value = data.testers.indexOf(first);
    other.value = data.testers.indexOf(embree ?? data.truth);
  }

  listen() {
    const on = (selector, event, act) => this.find(selector).addEventListener(event, act);
    on(".light", "change", (event) => this.chooseLight(Number(event.target.value)));
    on(".tester", "change", () => this.compare());
    on(".other", "change", () => this.compare());
    on(".zoom-in", "click", () => this.zoom(2));
    on(".zoom-out", "click", () => this.zoom(0.5));
    on(".fit", "click", () => { this.view.fit(); this.redraw(); });
    on(".previous", "click", () => this.step(-1));
    on(".next", "click", () => this.step(1));
    on(".rings", "change", () => this.redraw());
    this.slider.addEventListener("input", () => { this.sayWipe(); this.redraw(); });
    for (const axis of ["x", "y"]) {
      on(`.ask .${axis}`, "change", (event) => {
        this.pick({ ...this.pixel, [axis]: Number(event.target.value) || 0 });
        this.view.show(this.pixel.x, this.pixel.y);
      });
    }
    on(".copy", "click", (event) => copy(this.command(), event.target));
  }

  async chooseLight(light) {
    this.light = light;
    this.find(".light").value = light;
    if (!this.answersOf.has(light)) this.answersOf.set(light, await Answers.of(this.data, this.data.lights[light]));
    this.answers = this.answersOf.get(light);
    this.compare();
  }

  /** Nobody asks about the middle of a picture when there is something wrong elsewhere. */
  beginAtFirstWrong() {
    if (!this.wrong.length) return;
    const { at } = this.wrong[0];
    this.pixel = { x: at % this.data.width, y: Math.floor(at / this.data.width) };
    this.sayPixel(this.pixel, false);
    this.sayWhich();
  }

  name(tester) {
    const name = this.data.testers[tester];
    return name === this.data.truth ? "the truth" : name;
  }

  /** Everything that follows from the light and the two testers. */
  compare() {
    const { data, answers } = this;
    const { width, height, classes, differences } = data;
    answers.a = Number(this.find(".tester").value);
    answers.b = Number(this.find(".other").value);
    const shadows = (tester) => painted(width, height, classes, (at) => answers.shadow(tester, at)).canvas;
    const stops = answers.b === answers.truth ? [answers.a, answers.truth] : [answers.a, answers.b, answers.truth];
    this.stops = stops.map((tester) => ({ name: this.name(tester), image: shadows(tester) }));
    this.verdicts = painted(width, height, classes, (at) => answers.verdict(at));
    this.differences = painted(width, height, differences, (at) => answers.difference(at));
    const marks = (classOf, list) => {
      const found = [];
      for (let at = 0; at < width * height; at++) {
        const category = list[classOf(at)];
        if (category.wrong) found.push({ at, colour: css(category.colour) });
      }
      return found;
    };
    this.wrong = marks((at) => answers.verdict(at), classes);
    this.unlike = marks((at) => answers.difference(at), differences);
    this.slider.max = 100 * (stops.length - 1);
    this.find(".stops").replaceChildren(...this.stops.map(({ name }) => {
      const stop = document.createElement("span");
      stop.textContent = name;
      return stop;
    }));
    const two = `${this.name(answers.a)} against ${this.name(answers.b)}`;
    this.find("[data-panel=difference] .shown").textContent = two;
    this.legend("difference", differences, this.differences.counts);
    this.legend("verdict", classes, this.verdicts.counts);
    this.sayWipe();
    this.sayPixel(this.pixel, this.picked);
    this.sayWhich();
    this.redraw();
  }

  label(category) {
    const { a, b } = this.answers;
    return category.label.replace("%a", this.name(a)).replace("%b", this.name(b));
  }

  legend(panel, classes, counts) {
    const entries = [];
    classes.forEach((category, number) => {
      // That there is nothing wrong says something, of what is right only what is there.
      const always = category.wrong && !/[:]/.test(category.label) && !(panel === "verdict" && number === B_WRONG);
      if (!counts[number] && !always) return;
      const entry = document.createElement("li");
      const swatch = document.createElement("span");
      swatch.className = "swatch";
      swatch.style.background = css(category.colour);
      const count = document.createElement("b");
      count.textContent = counts[number].toLocaleString("en");
      entry.append(swatch, `${this.label(category)} `, count);
      if (category.wrong && counts[number]) entry.className = "wrong";
      entries.push(entry);
    });
    this.find(`[data-panel=${panel}] .legend`).replaceChildren(...entries);
  }

  /** The slider's place: the stop that fills the right, and the share of the next one on the left. */
  wipe() {
    const value = Number(this.slider.value);
    const stop = Math.min(Math.floor(value / 100), this.stops.length - 1);
    return { stop, share: Math.min(value - 100 * stop, 100) / 100 };
  }

  sayWipe() {
    const { stop, share } = this.wipe();
    const right = this.stops[stop].name;
    const text = share ? `${this.stops[stop + 1].name} on the left ${Math.round(100 * share)} %, ${right} on the right` : right;
    this.slider.setAttribute("aria-valuetext", text);
    this.find("[data-panel=shadows] .shown").textContent = text;
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.draw(); });
  }

  draw() {
    if (!this.answers) return;
    const { panels, data } = this;
    const marked = this.find(".rings").checked;
    const { stop, share } = this.wipe();
    const next = this.stops[Math.min(stop + 1, this.stops.length - 1)];
    const show = (panel, parts, smooth, marks, fill) => {
      const frame = panel.draw(parts, smooth);
      if (marked) panel.mark(frame, marks, data.rare, true, fill);
      panel.cursor(frame, this.pixel);
    };
    const whole = (image) => [{ image, until: 1 }];
    show(panels.picture, whole(this.image), true, this.wrong, false);
    const parts = [{ image: next.image, until: share }, { image: this.stops[stop].image, until: 1 }];
    show(panels.shadows, share ? parts : parts.slice(1), false, this.wrong, false);
    show(panels.difference, whole(this.differences.canvas), false, this.unlike, true);
    show(panels.verdict, whole(this.verdicts.canvas), false, this.wrong, true);
    const zoom = panels.verdict.scale;
    this.find(".zoom").textContent = zoom < 10 ? `${zoom.toFixed(zoom < 1 ? 2 : 1)}×` : `${Math.round(zoom)}×`;
    for (const panel of Object.values(panels)) panel.canvas.classList.toggle("moves", !this.view.isFit);
  }

  zoom(factor, x = this.pixel.x + 0.5, y = this.pixel.y + 0.5) {
    this.view.zoomBy(factor, x, y);
    this.redraw();
  }

  inside({ x, y }) {
    const clamp = (value, side) => Math.min(Math.max(Math.floor(value), 0), side - 1);
    return { x: clamp(x, this.data.width), y: clamp(y, this.data.height) };
  }

  /** Asks a pixel. */
  pick(place) {
    this.pixel = this.inside(place);
    this.picked = true;
    this.sayPixel(this.pixel, true);
    this.sayWhich();
    this.redraw();
  }

  /** The next wrong pixel from here, in the order of reading. */
  step(direction) {
    if (!this.wrong.length) return;
    const here = this.pixel.y * this.data.width + this.pixel.x;
    const places = this.wrong.map((mark) => mark.at);
    const found = direction > 0
      ? places.find((at) => at > here) ?? places[0]
      : places.findLast((at) => at < here) ?? places[places.length - 1];
    this.goTo(found % this.data.width, Math.floor(found / this.data.width));
  }

  goTo(x, y) {
    this.pick({ x, y });
    this.view.show(x + 0.5, y + 0.5);
  }

  sayWhich() {
    const here = this.pixel.y * this.data.width + this.pixel.x;
    const place = this.wrong.findIndex((mark) => mark.at === here);
    const count = this.wrong.length.toLocaleString("en");
    this.find(".which").textContent = place < 0 ? `${count} wrong` : `${(place + 1).toLocaleString("en")} of ${count}`;
    for (const button of this.root.querySelectorAll(".previous, .next")) button.disabled = !this.wrong.length;
  }

  command({ x, y } = this.pixel) {
    return `${this.data.replay} --pixel ${x},${y} --light ${this.data.quoted[this.light]}`;
  }

  /** What is known of a pixel. Only one that was chosen is read out, and has a command. */
  sayPixel(pixel, chosen) {
    const { data, answers } = this;
    const at = pixel.y * data.width + pixel.x;
    const category = data.classes[answers.verdict(at)];
    const object = this.objectAt(at);
    const chip = document.createElement("span");
    chip.className = category.wrong ? "chip wrong" : "chip";
    chip.style.setProperty("--chip", css(category.colour));
    chip.textContent = this.label(category);
    const rest = [];
    if (answers.isQuery(at)) {
      rest.push(`the truth: ${answers.occluded(answers.truth, at) ? "occluded" : "lit"}`);
      if (answers.isTouching(at)) rest.push("the segment touches an edge");
      if (answers.cause(at)) rest.push(`embree is wrong by ${CAUSES[answers.cause(at)]}`);
    }
    if (object) rest.push(`object ${object}`);
    const finding = this.find(".finding");
    finding.setAttribute("aria-live", chosen ? "polite" : "off");
    const where = document.createElement("span");
    where.className = "where";
    where.textContent = `${pixel.x},${pixel.y}`;
    finding.replaceChildren(where, " ", chip, ` ${rest.join(" · ")}`);
    this.find(".ask .x").value = pixel.x;
    this.find(".ask .y").value = pixel.y;
    this.find(".answers").replaceChildren(...(answers.isQuery(at) ? data.testers : []).map((name, tester) => {
      const entry = document.createElement("li");
      const occluded = answers.occluded(tester, at);
      const wrong = occluded !== answers.occluded(answers.truth, at);
      entry.textContent = `${name === data.truth ? "truth" : name}: ${occluded ? "occluded" : "lit"}${wrong ? " ✗ wrong" : ""}`;
      entry.className = wrong ? "wrong" : "";
      return entry;
    }));
    this.find(".replay code").textContent = this.command(pixel);
  }

  /** Pointers, wheel and keys of a panel. */
  follow(panel) {
    const { canvas } = panel;
    const pointers = new Map();
    let moved = 0;
    const spread = () => {
      const [one, other] = [...pointers.values()];
      return Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY);
    };
    canvas.addEventListener("pointerdown", (event) => {
      pointers.set(event.pointerId, event);
      moved = 0;
      if (event.pointerType === "mouse") canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) {
        if (event.pointerType === "mouse") this.sayPixel(this.inside(panel.placeOf(event)), false);
        return;
      }
      const apart = pointers.size === 2 ? spread() : 0;
      pointers.set(event.pointerId, event);
      const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
      moved += Math.hypot(dx, dy);
      if (pointers.size === 2 && apart > 0) {
        const place = panel.placeOf(event);
        this.view.zoomBy(spread() / apart, place.x, place.y);
      } else if (moved > 4) {
        this.view.moveBy(-dx / panel.scale, -dy / panel.scale);
      }
      this.redraw();
    });
    const leave = (event) => {
      pointers.delete(event.pointerId);
      if (!pointers.size) this.sayPixel(this.pixel, this.picked);
    };
    canvas.addEventListener("pointerup", (event) => {
      const isClick = pointers.size === 1 && moved <= 4;
      pointers.delete(event.pointerId);
      if (isClick) this.pick(panel.placeOf(event));
    });
    canvas.addEventListener("pointercancel", leave);
    canvas.addEventListener("pointerleave", leave);
    canvas.addEventListener("dblclick", (event) => {
      const place = panel.placeOf(event);
      this.zoom(2, place.x, place.y);
    });
    canvas.addEventListener("wheel", (event) => {
      // A page that is scrolled is not zoomed by the way.
      if (!event.ctrlKey && !event.metaKey && document.activeElement !== canvas) return;
      event.preventDefault();
      const place = panel.placeOf(event);
      this.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.002)), place.x, place.y);
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const far = event.shiftKey ? 10 : 1;
    const moves = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] };
    const acts = {
      "+": () => this.zoom(2),
      "=": () => this.zoom(2),
      "-": () => this.zoom(0.5),
      0: () => { this.view.fit(); this.redraw(); },
      n: () => this.step(1),
      p: () => this.step(-1),
    };
    if (moves[event.key]) {
      const [x, y] = moves[event.key];
      this.pick({ x: this.pixel.x + x, y: this.pixel.y + y });
      this.view.show(this.pixel.x + 0.5, this.pixel.y + 0.5);
    } else if (acts[event.key]) {
      acts[event.key]();
    } else {
      return;
    }
    event.preventDefault();
  }
}
